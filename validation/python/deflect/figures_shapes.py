"""Pictures of drawings and of checked matrices: see figures.py."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._sheet import BAND, COLOURS, DARK, GREY, LINE, Sheet, clip

ORANGE = COLOURS[1]
#: rows: what lies to the right and up in a view from the front, from above and askew, in base axes
VIEWS = (("front: z over x (mm)", (1, 0, 0), (0, 0, 1)), ("above: y over x (mm)", (1, 0, 0), (0, 1, 0)),
         ("askew", (0.819, 0.574, 0), (-0.235, 0.336, 0.912)))


def drawing(d: Any, figure: Any = None) -> Any:
    """Members, joints (dots; orange: driven) and base, tool or nodes (squares) from the front, from above and askew, to
    one scale; a motion that nothing resists, dashed."""
    notes = [d.about] + ([d.trouble] if d.trouble else [])
    sheet = Sheet(f"{d.name}, as drawn", notes, figure=figure)
    points = d.points_mm.reshape(-1, 3)
    joints = np.array([j.at_mm for j in d.joints]).reshape(-1, 3)
    frames = np.array([f.at_mm for f in d.frames]).reshape(-1, 3)
    everything = np.concatenate([points, joints, frames])
    spans = [[np.ptp(everything @ np.array(axis)) for axis in view[1:]] for view in VIEWS]
    widest = max(max(across, up) for across, up in spans) or 1.0
    side, top = 39.0, sheet.y + 2.2 * LINE
    for k, (name, right, up) in enumerate(VIEWS):
        x = 18 + k * (side + 11)
        sheet.text(name, x, top - 1.2 * LINE, color=DARK)
        axes = sheet.panel(x, top, side, side)
        flat = np.array([right, up], dtype=float).T
        _lines(axes, d, points @ flat, "-", 1.2, COLOURS[0])
        for motion in d.motions[:1]:
            _lines(axes, d, (points + motion.displacement_mm) @ flat, "--", 0.8, ORANGE)
        for j, at in zip(d.joints, joints @ flat):
            axes.plot(*at, "o", color=ORANGE if j.driven else DARK, markersize=3 if j.driven else 2)
        if len(frames) <= 2:
            axes.plot(*(frames @ flat).T, "s", color=DARK, markersize=4, fillstyle="none")
        centre = 0.5 * ((everything @ flat).max(axis=0) + (everything @ flat).min(axis=0))
        axes.set_xlim(centre[0] - 0.54 * widest, centre[0] + 0.54 * widest)
        axes.set_ylim(centre[1] - 0.54 * widest, centre[1] + 0.54 * widest)
        axes.locator_params(nbins=4)
        if k == 2:
            axes.set_xticklabels([])
            axes.set_yticklabels([])
    sheet.y = top + side
    return sheet.done(1.6 * LINE)


def _lines(axes: Any, d: Any, at: np.ndarray, style: str, width: float, colour: str) -> None:
    for a, b, member in d.lines:
        axes.plot(*at[[a, b]].T, style, lw=width if member >= 0 else 0.6, color=colour if member >= 0 else GREY)


def check(c: Any, figure: Any = None) -> Any:
    """The entries by their size, |K_ij| over √|K_ii K_jj|, and the eigenvalues, with rotations weighed; above, what is
    wrong."""
    sheet = Sheet(f"{clip(c.file, 40)}: {'all checks pass' if c.passes else 'checks fail'}", [c.verdict], figure=figure)
    K = c.matrix
    scale = np.sqrt(np.abs(np.outer(np.diag(K), np.diag(K))))
    with np.errstate(divide="ignore", invalid="ignore"):
        size = np.where(scale > 0, np.abs(K) / scale, np.nan)
    top, side = sheet.y + LINE, 50.0
    axes = sheet.panel(18, top, side, side)
    axes.grid(False)
    image = axes.imshow(size, vmin=0, vmax=1, cmap="viridis", aspect="auto")
    axes.set_xticks(range(6), ("ux", "uy", "uz", "thx", "thy", "thz"))
    axes.set_yticks(range(6), ("fx", "fy", "fz", "mx", "my", "mz"))
    sheet.figure.colorbar(image, cax=sheet.panel(18 + side + 2, top, 3, side), label="|K_ij| / √|K_ii K_jj|")
    bars = sheet.panel(108, top, sheet.width - 112, side)
    values = c.eigenvalues_N_per_mm
    bars.bar(range(1, 7), np.abs(values), color=[COLOURS[0] if x > 0 else ORANGE for x in values], width=0.6)
    bars.set_xticks(range(1, 7))
    if np.all(values != 0):
        bars.set_yscale("log")
    bars.set_facecolor("white" if c.passes else BAND)
    bars.set_xlabel("eigenvalue (orange: not above zero)")
    bars.set_ylabel("N/mm")
    sheet.y = top + side
    return sheet.done()
