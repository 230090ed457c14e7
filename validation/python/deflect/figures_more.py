"""Pictures of fits, predictions, plans, validations against measurements and frames: see figures.py."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._sheet import COLOURS, DARK, LINE, MARKERS, Sheet, clip
from .figures import _before_after

ORANGE = COLOURS[1]
MOST = 24  # rows of a frame's case


def fit(f: Any, figure: Any = None) -> Any:
    """Each parameter with its 95 % interval, relative to what the description said; the error before and after."""
    c = f.content
    rows = c["parameters"]
    words = "value and 95 % interval, relative to the value before"
    if any("of" in p for p in rows):
        words += "; of an effect to where the search began"
    sheet = Sheet("Fitted parameters", [f"{c['device']} against {c['data']}", words], figure=figure)
    top, h = sheet.y + LINE, max(30.0, 6.0 * len(rows))
    axes = sheet.panel(52, top, 48, h)
    for i, p in enumerate(rows):
        before = p["before"] or 1.0
        values = np.array([p[k] if p[k] is not None else np.nan for k in ("low95", "value", "high95")], dtype=float)
        axes.plot(values[[0, 2]] / before, [i, i], "-", color=COLOURS[0], lw=2)
        axes.plot(values[1] / before, i, "o", color=COLOURS[0], markersize=4)
    axes.axvline(1, color=DARK, lw=0.7)
    axes.set_yticks(range(len(rows)), [clip(p["path"], 28) for p in rows])
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.set_xlabel("value / value before")
    _before_after(sheet.panel(118, top, sheet.width - 122, h), c["before"], c["after"], c["noise_floor_mm"], c["unit"],
                  ("before", "fitted"))
    sheet.y = top + h
    return sheet.done()


def prediction(p: Any, figure: Any = None) -> Any:
    """Readings with their 95 % intervals, a panel for each unit; and what the theories differ from the value by."""
    c = p.content
    numbers, units = c["numbers"], list(dict.fromkeys(n["unit"] for n in c["numbers"]))
    sheet = Sheet("Predicted readings with 95 % intervals", [c["device"]], figure=figure)
    for unit in units:
        rows = [n for n in numbers if n["unit"] == unit]
        axes = sheet.below(38, 1.4 * LINE)
        for i, n in enumerate(rows):
            colour = COLOURS["xyz".index(n["channel"][-1])] if n["channel"][-1] in "xyz" else COLOURS[0]
            axes.plot([i, i], [n["low95"], n["high95"]], "-", color=colour, lw=1.6)
            axes.plot(i, n["value"], "o", color=colour, markersize=3)
        axes.axhline(0, color=DARK, lw=0.7)
        few = len(rows) <= 24
        axes.set_xticks(range(len(rows)) if few else [], [n["channel"] for n in rows] if few else [])
        axes.set_ylabel(f"reading ({unit})")
        sheet.y += 1.2 * LINE
    return sheet.done(LINE)


def plan(p: Any, figure: Any = None) -> Any:
    """Before measuring: how alike the effects of every pair look in the given and in the better campaign. After a
    diagnosis: the expected probability of the right effect by the number of readings."""
    c = p.content
    if "given" in c:
        return _cosines(c, figure)
    steps = c["steps"]
    sheet = Sheet("Expected probability of the right effect", [f"{c.get('subject', c.get('device', ''))}"], figure=figure)
    axes = sheet.below(55, 1.5 * LINE)
    axes.plot([s["readings"] for s in steps], [s["probability"] for s in steps], "o-", color=COLOURS[0], markersize=3)
    axes.set_ylim(0, 1.02)
    axes.set_xlabel("further readings")
    axes.set_ylabel("probability")
    return sheet.done()


def _cosines(c: dict, figure: Any) -> Any:
    given, better, found = c["given"], c["better"], c["better_found"]
    names = [d["effect"] for d in given["detectable"]]
    sheet = Sheet("How alike effects look: |cosine| of their signatures",
                  [f"{c['subject']}, {c['campaign']}: {given['pairs_told_apart']} of {given['pairs']} pairs told apart; "
                   + (f"the better plan: {better['pairs_told_apart']}" if found else "no better plan was found")],
                  figure=figure)
    side, height = 48.0, max(30.0, 2.7 * len(names))  # so that every name can be read
    image = None
    for k, (title, one) in enumerate((("given", given), ("better", better))[:2 if found else 1]):
        axes = sheet.panel(40 + k * (side + 4), sheet.y + 2 * LINE, side, height)
        axes.grid(False)
        image = axes.imshow(np.abs(np.array(one["cosines"], dtype=float)), vmin=0, vmax=1, cmap="viridis", aspect="auto")
        axes.set_title(title, fontsize=8, loc="left")
        axes.set_xticks([])
        axes.set_yticks(range(len(names)) if k == 0 else [], [clip(n, 30) for n in names] if k == 0 else [],
                        fontsize=6)
        axes.tick_params(length=0)
    bar = sheet.panel(40 + (2 if found else 1) * (side + 4), sheet.y + 2 * LINE, 3, height)
    sheet.figure.colorbar(image, cax=bar, label="|cosine|")
    sheet.y += 2 * LINE + height
    return sheet.done(LINE)


def validity(v: Any, figure: Any = None) -> Any:
    """Error of each channel, bias and rms, over the standard deviation that it may have; and the distribution function
    of all, which is the diagonal where the model is right."""
    c = v.content
    rows = [r for r in c["channels"] if r.get("u_val")]
    sheet = Sheet("Errors over their validation uncertainty", [f"{c['device']} against {c['data']}", c["sentence"]],
                  figure=figure)
    top = sheet.y + LINE
    axes = sheet.panel(22, top, 62, 50)
    for i, r in enumerate(rows):
        axes.bar(i, r["rms_E"] / r["u_val"], 0.5, color=COLOURS[0])
        axes.plot(i, r["mean_E"] / r["u_val"], "D", color=ORANGE, markersize=4)
    axes.axhline(c["coverage_factor"], color=ORANGE, ls="--")
    axes.set_xticks(range(len(rows)), [clip(r["name"], 10) for r in rows])
    axes.set_ylabel("rms (bar) and mean of E / u_val")
    other = sheet.panel(105, top, 50, 50)
    other.plot([0, 1], [0, 1], color=DARK, lw=0.7)
    other.plot([x["u"] for x in c["u"]], [x["F"] for x in c["u"]], color=COLOURS[0])
    other.set_xlabel("probability by the model")
    other.set_ylabel("share of readings below")
    sheet.y = top + 50
    return sheet.done()


def frame(f: Any, figure: Any = None) -> Any:
    """By load case: displacements of the nodes, and the axial force in the members; at most MOST of each, the largest."""
    cases = f.content["cases"]
    first = next(iter(cases.values()))
    left_out = [f"the {MOST} largest of {len(first[what])} {words}" for what, words in
                (("displacements", "nodes"), ("members", "members")) if len(first[what]) > MOST]
    sheet = Sheet(f"{f.content['frame']}: displacements and axial forces",
                  ["; ".join([f"{f.content['geometry']} geometry, MSA", *left_out])], figure=figure)
    for case in cases:
        d, m = f.displacements(case), f.members(case)
        u = np.stack([d[key] for key in ("ux_mm", "uy_mm", "uz_mm")])
        nodes = np.sort(np.argsort(-np.abs(u).max(axis=0))[:MOST])
        force = m["start.N_N"] if "start.N_N" in m else np.zeros(0)
        members = np.sort(np.argsort(-np.abs(force))[:MOST])
        top, h = sheet.y + 2 * LINE, max(28.0, 4.2 * max(len(nodes), len(members)))
        sheet.text(f"case {case}", 3, top - 1.5 * LINE, weight="bold")
        axes = sheet.panel(26, top, 52, h)
        for k in range(3):
            axes.plot(u[k, nodes], np.arange(len(nodes)) + 0.2 * (k - 1), MARKERS[k], color=COLOURS[k], markersize=3,
                      label=("ux", "uy", "uz")[k])
        axes.axvline(0, color=DARK, lw=0.7)
        axes.set_yticks(range(len(nodes)), [clip(d["node"][i], 12) for i in nodes])
        axes.set_ylim(len(nodes) - 0.5, -0.5)
        axes.set_xlabel("displacement (mm)")
        axes.legend(ncol=3, loc="lower right", bbox_to_anchor=(1, 1), frameon=False, handletextpad=0, columnspacing=0.8)
        if len(members):
            bars = sheet.panel(104, top, sheet.width - 108, h)
            bars.barh(range(len(members)), force[members], color=[COLOURS[0] if x >= 0 else ORANGE for x in force[members]],
                      height=0.6)
            bars.axvline(0, color=DARK, lw=0.7)
            bars.set_yticks(range(len(members)), [clip(m["member"][i], 14) for i in members])
            bars.set_ylim(len(members) - 0.5, -0.5)
            bars.set_xlabel("axial force (N), tension positive")
        sheet.y = top + h + 2.4 * LINE
    return sheet.done(LINE)
