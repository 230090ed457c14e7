"""What a notebook shows of a result: its sentence, its picture where matplotlib is, its table, and the report to unfold."""

from __future__ import annotations

import base64
import html
import importlib
import sys
from typing import Any, Callable

from . import _sheet

#: members of the JSON that say a result in a sentence, the first of them that it has
SENTENCES = ("sentence", "verdict")
TABLE = ("style='border-collapse:collapse;font-size:90%'", "style='padding:1px 8px;text-align:right'")


def drawn(result: Any, figure: Any = None) -> Any:
    """The picture of a result, by the function that its class names."""
    if not result._drawn_by:
        raise TypeError(f"a {type(result).__name__} has no picture")
    module, name = result._drawn_by.split(".")
    return getattr(importlib.import_module("." + module, __package__), name)(result, figure)


def progress(what: str) -> Callable[[float], None]:
    """Shows the share that is done: in a notebook by a bar, in a terminal by a line of standard error."""
    IPython = sys.modules.get("IPython")
    shell = IPython.get_ipython() if IPython else None
    if shell is not None and hasattr(shell, "kernel"):
        return _bar(what)

    def tell(share: float) -> None:
        print(f"\r{what} {100 * share:3.0f} %", end="\n" if share >= 1 else "", file=sys.stderr, flush=True)

    return tell


def _bar(what: str) -> Callable[[float], None]:
    """An output of the cell that is written anew in its place."""
    from IPython.display import HTML, display

    def words(share: float) -> Any:
        return HTML(f"<progress value='{share:.3f}' max='1'></progress> {html.escape(what)} {100 * share:.0f} %")

    handle = display(words(0), display_id=True)
    return lambda share: handle.update(words(share))


def heading(words: str) -> str:
    return f"<p><b>{html.escape(words)}</b></p>"


def table_of(rows: list[dict[str, Any]], most: int = 10) -> str:
    """The first rows, and how many more there are. Lists and what is in all rows empty are left out."""
    shown = rows[:most]
    names = [n for n in dict.fromkeys(k for row in shown for k in row)
             if any(row.get(n) is not None and not isinstance(row.get(n), (list, dict)) for row in shown)]
    head = "".join(f"<th {TABLE[1]}>{html.escape(n)}</th>" for n in names)
    body = "".join("<tr>" + "".join(f"<td {TABLE[1]}>{html.escape(_cell(row.get(n)))}</td>" for n in names) + "</tr>"
                   for row in shown)
    more = f"<p>… and {len(rows) - most} more rows</p>" if len(rows) > most else ""
    return f"<table {TABLE[0]}><tr>{head}</tr>{body}</table>{more}" if names else ""


def _cell(value: Any) -> str:
    if value is None or isinstance(value, (list, dict)):
        return ""
    if isinstance(value, float):
        return f"{value:.6g}"
    text = str(value)
    return text if len(text) <= 60 else text[:59] + "…"


def _picture(result: Any) -> str:
    """An inline PNG; nothing without matplotlib, and where a result has no picture."""
    try:
        figure = drawn(result)
    except (ImportError, TypeError, ValueError):
        return ""
    return f"<img alt='' src='data:image/png;base64,{base64.b64encode(_sheet.small_png(figure, 96)).decode()}'/>"


def html_of(result: Any) -> str:
    content = result.content
    first = next((line for line in result.report.splitlines() if line.strip()), "")
    said = next((content[k] for k in SENTENCES if isinstance(content.get(k), str)), first)
    return (heading(said) + _picture(result) + table_of(result.rows())
            + f"<details><summary>report</summary><pre style='line-height:1.25'>{html.escape(result.report)}</pre>"
            "</details>")
