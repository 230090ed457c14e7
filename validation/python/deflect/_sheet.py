"""A figure by matplotlib in the style of the program's: laid out in mm from its upper left corner, text of 8 pt."""

from __future__ import annotations

import io
import textwrap
from typing import Any, Iterable

#: Of the axes x, y and z: colours by Okabe and Ito, which any colour vision tells apart; lighter ones; markers.
COLOURS = ("#0072B2", "#D55E00", "#009E73")
LIGHT = ("#8CC4E8", "#F3B587", "#8ED6BF")
MARKERS = ("o", "s", "D")
GREY, DARK, BAND = "#BBBBBB", "#404040", "#E8E8E8"
LINE = 4.0  # mm from one line of text to the next


def require(module: str, package: str) -> Any:
    """The module; ImportError says how to install it."""
    import importlib

    try:
        return importlib.import_module(module)
    except ImportError as missing:
        raise ImportError(f"this needs {module.split('.')[0]}: apt install {package}, or pip install "
                          f"{module.split('.')[0]} ({missing})", name=missing.name) from missing


def pandas() -> Any:
    return require("pandas", "python3-pandas")


def style() -> dict[str, Any]:
    return {"font.family": "DejaVu Sans", "font.size": 8, "axes.labelsize": 8, "xtick.labelsize": 8,
            "ytick.labelsize": 8, "legend.fontsize": 8, "axes.edgecolor": DARK, "axes.linewidth": 0.7,
            "axes.grid": True, "axes.axisbelow": True, "grid.color": "#E0E0E0", "grid.linewidth": 0.5,
            "axes.spines.top": False, "axes.spines.right": False, "lines.linewidth": 1, "xtick.major.width": 0.7,
            "ytick.major.width": 0.7, "xtick.major.size": 2, "ytick.major.size": 2, "svg.fonttype": "none"}


class Sheet:
    """Heading first, then panels from above; ``done`` cuts the paper behind the last one."""

    def __init__(self, title: str, notes: Iterable[str] = (), width_mm: float = 160, figure: Any = None):
        matplotlib = require("matplotlib", "python3-matplotlib")
        self.width, self.left = width_mm, 22.0
        self.placed: list[tuple[Any, float, float, float, float]] = []
        self._context = matplotlib.rc_context(style())
        self._context.__enter__()
        self.figure = _figure_class()(dpi=110) if figure is None else figure
        self.texts: list[tuple[Any, float, float]] = []
        self.y = 3.0
        self.text(title, 3, self.y, weight="bold", size=9.5)
        self.y += 1.3 * LINE
        for note in notes:
            for line in textwrap.wrap(note, int(width_mm / 1.62)):
                self.text(line, 3, self.y, color="#505050", size=7.5)
                self.y += LINE

    def text(self, words: str, x: float, y: float, **how: Any) -> None:
        """(x, y): its upper left corner, or as ``ha`` and ``va`` say."""
        self.texts.append((self.figure.text(0, 0, words, **{"va": "top", "ha": "left", "parse_math": False, **how}), x, y))

    def panel(self, x: float, y: float, w: float, h: float, **how: Any) -> Any:
        axes = self.figure.add_axes([0, 0, 1, 1], label=str(len(self.placed)), **how)
        self.placed.append((axes, x, y, w, h))
        return axes

    def below(self, h: float, gap: float = LINE, left: float | None = None, right: float = 4, **how: Any) -> Any:
        """A panel of the full width under what stands there."""
        left = self.left if left is None else left
        axes = self.panel(left, self.y + gap, self.width - left - right, h, **how)
        self.y += gap + h
        return axes

    def legend(self, entries: Iterable[tuple[Any, str]], columns: int = 3) -> None:
        """Marks (artists) with their names, under the heading."""
        from matplotlib.legend import Legend

        marks, names = zip(*entries)
        axes = self.panel(3, self.y + 1, 1, 1)
        axes.set_axis_off()
        axes.add_artist(Legend(axes, marks, names, ncol=columns, loc="upper left", bbox_to_anchor=(0, 1), frameon=False,
                               borderpad=0, handletextpad=0.4, columnspacing=1.5, borderaxespad=0))
        self.y += 1 + 1.15 * LINE * -(-len(names) // columns)

    def done(self, room: float = 2.6 * LINE) -> Any:
        """``room``: under the last panel, for its numbers and the name of its axis."""
        height = self.y + room
        self.figure.set_size_inches(self.width / 25.4, height / 25.4)
        for text, x, y in self.texts:
            text.set_position((x / self.width, 1 - y / height))
        for axes, x, y, w, h in self.placed:
            axes.set_position([x / self.width, 1 - (y + h) / height, w / self.width, h / height])
        self._context.__exit__(None, None, None)
        return self.figure


def _figure_class() -> type:
    """matplotlib's Figure, which a notebook shows without pyplot. savefig writes 300 dpi."""
    from matplotlib.figure import Figure

    class Picture(Figure):
        def savefig(self, path: Any, **how: Any) -> None:
            super().savefig(path, **{"dpi": 300, **how})

        def _repr_png_(self) -> bytes:
            return small_png(self, 110)

    return Picture


def small_png(figure: Any, dpi: int) -> bytes:
    """In 256 colours, for notebooks. Pillow comes with matplotlib."""
    from PIL import Image

    full, out = io.BytesIO(), io.BytesIO()
    figure.savefig(full, format="png", dpi=dpi)
    Image.open(full).convert("RGB").quantize(256, dither=Image.Dither.NONE).save(out, format="png", optimize=True)
    return out.getvalue()


def nice_below(x: float) -> float:
    """1, 2 or 5 times a power of ten, the largest that is not above x > 0."""
    import math

    power = 10.0 ** math.floor(math.log10(x))
    return next(lead for lead in (5, 2, 1) if lead * power <= x * (1 + 1e-12)) * power


def readable(largest: float, of: str = "m") -> tuple[str, float]:
    """For a number in thousandths of ``of`` ("m": mm, "rad": mrad): the unit in which it is at least 1, and its factor."""
    for letter, factor in (("m", 1.0), ("µ", 1e3), ("n", 1e6), ("p", 1e9)):
        if largest * factor >= 1:
            return letter + of, factor
    return ("n" + of, 1e6) if largest == 0 else ("f" + of, 1e12)


def fine(unit: str) -> tuple[str, float]:
    """A unit a thousand times smaller, for residuals, and how many of it are one."""
    finer = {"mm": ("µm", 1e3), "rad": ("mrad", 1e3), "mrad": ("µrad", 1e3), "m": ("mm", 1e3), "um_per_m": ("µm/m", 1.0)}
    return finer.get(unit, (unit, 1.0))


def clip(words: Any, most: int) -> str:
    words = str(words)
    return words if len(words) <= most else words[: most - 1] + "…"
