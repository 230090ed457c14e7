"""Pictures of results by matplotlib, in the style of the program's figures: ``result.plot()``. Each function here takes
a result and a figure to draw into (None: a new one), and returns the figure."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._sheet import BAND, COLOURS, DARK, GREY, LIGHT, LINE, MARKERS, Sheet, clip, fine, nice_below, readable

ORANGE = COLOURS[1]


def _mark(**how: Any) -> Any:
    from matplotlib.lines import Line2D

    return Line2D([], [], **{"linestyle": "none", **how})


def _bar(colour: str) -> Any:
    from matplotlib.patches import Patch

    return Patch(color=colour)


def _titles(content: dict) -> list[tuple[str, str]]:
    return [(t["name"], t["title"]) for t in content["theories"]]


def solution(s: Any, figure: Any = None) -> Any:
    """Displacement by every theory, what they differ by, and the share of each part in the strain energy."""
    c = s.content
    theories = _titles(c)
    load = ", ".join(f"{x:g}" for x in c["load"])
    sheet = Sheet("Displacement of the tool point", [f"load {load} (N, Nmm), base axes"], figure=figure)
    sheet.legend([(_mark(marker="os^v"[i % 4], color="k", fillstyle="full" if i == 0 else "none",
                         markersize=3 if i == 0 else 6), title) for i, (_, title) in enumerate(theories)])
    top, height = sheet.y + LINE, 42.0
    for turn, (unit, factor, names) in enumerate((("mm", 1, ("ux", "uy", "uz")), ("mrad", 1e3, ("thx", "thy", "thz")))):
        x = sheet.left + turn * 50
        axes, strip = sheet.panel(x, top, 31, height), sheet.panel(x, top + height + LINE, 31, 14)
        d = np.array([c[name]["displacement"] for name, _ in theories])[:, 3 * turn: 3 * turn + 3] * factor
        differences = d[0] - d[1:]
        small, per = readable(np.abs(differences).max() if differences.size else 0, unit[1:])
        for i in range(3):
            for t in range(len(theories)):
                axes.plot(i, d[t, i], MARKERS[i], color=COLOURS[i], fillstyle="full" if t == 0 else "none",
                          markersize=3 if t == 0 else 7)
            for value in differences[:, i]:
                strip.plot([i, i], [0, value * per], "-", color=COLOURS[i])
                strip.plot(i, value * per, MARKERS[i], color=COLOURS[i], markersize=3)
        axes.axhline(0, color=DARK, lw=0.7)
        axes.set_ylabel(f"displacement ({unit})")
        axes.set_xticks(range(3), [])
        strip.axhline(0, color=DARK, lw=0.7)
        strip.set_ylabel(f"difference\n({small})")
        strip.set_xticks(range(3), names)
        for each in (axes, strip):
            each.set_xlim(-0.6, 2.6)
    shares = c["shares"]
    axes = sheet.panel(132, top, sheet.width - 136, height + LINE + 14)
    axes.barh(range(len(shares)), [100 * p["share"] for p in shares], color=COLOURS[0], height=0.6)
    axes.set_yticks(range(len(shares)), [clip(p["part"], 16) for p in shares])
    axes.invert_yaxis()
    axes.set_xlabel("energy (%)")
    sheet.y = top + height + LINE + 14
    return sheet.done()


def validation(v: Any, figure: Any = None) -> Any:
    """Fig. 10: displacement along the force at the points, by every theory; below, what the theories differ by."""
    c = v.content
    theories, points = _titles(c), list(dict.fromkeys(p["point"] for p in c["points"]))
    along: dict[str, np.ndarray] = {name: np.full((len(points), 3), np.nan) for name, _ in theories}
    for p in c["points"]:
        axis = "xyz".index(p["load_axis"])
        for name, _ in theories:
            along[name][points.index(p["point"]), axis] = p[name][axis]
    sheet = Sheet(f"{c['device']}: linear deflection under {c['points'][0]['load_N']:g} N in x, y, z",
                  ["Force at the tool point, its displacement along the force, base axes"], figure=figure)
    sheet.legend([(_mark(marker=MARKERS[k], color=COLOURS[k], fillstyle="full" if t == 0 else "none",
                         markersize=3 if t == 0 else 7), f"{'XYZ'[k]}-{title}")
                  for k in range(3) for t, (_, title) in enumerate(theories)])
    several = len(theories) > 1
    axes = sheet.below(62, 1.5 * LINE)
    at = np.arange(len(points))
    aside = 0.16
    for k in range(3):
        for t, (name, _) in enumerate(theories):
            axes.plot(at + (k - 1) * aside, along[name][:, k], MARKERS[k], color=COLOURS[k],
                      fillstyle="full" if t == 0 else "none", markersize=3 if t == 0 else 7)
    axes.set_ylabel("deflection along the load (mm)")
    axes.set_xticks(at, [""] * len(points) if several else points)
    last = axes
    if several:
        last = sheet.below(22, 1.25 * LINE)
        first, others = along[theories[0][0]], [along[name] for name, _ in theories[1:]]
        small, per = readable(max(np.nanmax(np.abs(first - other)) for other in others))
        for k in range(3):
            for other in others:
                difference = (first[:, k] - other[:, k]) * per
                last.vlines(at + (k - 1) * aside, 0, difference, color=COLOURS[k])
                last.plot(at + (k - 1) * aside, difference, MARKERS[k], color=COLOURS[k], markersize=3)
        last.axhline(0, color=DARK, lw=0.7)
        last.set_ylabel(f"{theories[0][1]} − {theories[1][1] if len(others) == 1 else 'others'}\n({small})")
        last.set_xticks(at, points)
    last.set_xlabel("point of the workspace")
    for each in (axes, last):
        each.set_xlim(-0.5, len(points) - 0.5)
    return sheet.done()


def stiffness_map(m: Any, figure: Any = None) -> Any:
    """Fig. 11: slices of the stiffness along x, y and z over the workspace, on one logarithmic scale of colours."""
    from matplotlib.colors import LogNorm
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    c = m.content
    theory, title = _titles(c)[0]
    grid = [np.array(c["grid"][f"{a}_mm"]) for a in "xyz"]
    values = [m.columns[f"{theory}.stiffness_{a}_N_per_mm"].reshape([len(g) for g in reversed(grid)]) for a in "xyz"]
    nx, ny, nz = (len(g) for g in grid)
    slices = []
    if nx > 1 and ny > 1:
        slices += [(0, 1, k) for k in sorted({nz - 1, (nz - 1) // 2, 0}, reverse=True)]
    if nz > 1 and (nx > 1 or ny > 1):
        slices.append((0, 2, (ny - 1) // 2) if nx > 1 else (1, 2, (nx - 1) // 2))
    if not slices:
        raise ValueError("a map along one line has no slices to draw: plot its columns")
    differ = f"; the theories within {c['max_relative_difference']:.1g}" if len(c["theories"]) > 1 else ""
    load = f"{c['force_N']:g} N along x, y, z in turn" if c.get("force_N") else "under one load"
    sheet = Sheet(f"{c['device']}: stiffness over the workspace",
                  [f"1/C_ii at the tool point, base axes, {c['compliance_kind']}; {load}",
                   f"{title} theory{differ}; grey: out of reach"], 170, figure)
    low, high = min(np.nanmin(v) for v in values), max(np.nanmax(v) for v in values)
    norm = LogNorm(low, max(high, 1.001 * low))
    left, gap, w = 14.0, 4.5, 41.0
    top = sheet.y + 2.2 * LINE
    image = None
    for r, (across, up, where) in enumerate(slices):
        h = float(np.clip(w * np.ptp(grid[up]) / np.ptp(grid[across]), 0.5 * w, 1.4 * w))
        fixed = 3 - across - up
        y = sheet.y + 2.4 * LINE
        sheet.text(f"{'xyz'[fixed]} = {grid[fixed][where]:.4g} mm", left, y - LINE)
        for k in range(3):
            axes = sheet.panel(left + k * (w + gap), y, w, h)
            field = np.take(values[k], where, axis=2 - fixed)
            axes.grid(False)
            axes.set_facecolor("#D8D8D8")
            image = axes.pcolormesh(grid[across], grid[up], field, norm=norm, cmap="viridis", shading="gouraud",
                                    rasterized=True)
            if np.isfinite(field).sum() > 3 and np.nanmax(field) > 1.02 * np.nanmin(field):
                levels = _levels(np.nanmin(field), np.nanmax(field))
                curves = axes.contour(grid[across], grid[up], field, levels=levels, linewidths=0.6,
                                      colors=["k" if norm(each) > 0.62 else "w" for each in levels])
                axes.clabel(curves, fmt="%g", fontsize=6.5)
            axes.set_xlabel(f"{'xyz'[across]} (mm)", labelpad=1)
            for side in ("top", "right"):
                axes.spines[side].set_visible(True)
            if k == 0:
                axes.set_ylabel(f"{'xyz'[up]} (mm)")
            else:
                axes.set_yticklabels([])
            if r == 0:
                sheet.text(f"force along {'xyz'[k]}", left + k * (w + gap) + w, y - 1.9 * LINE, ha="right", weight="bold",
                           color=COLOURS[k])
        sheet.y = y + h + 1.6 * LINE
    bar = sheet.panel(left + 3 * (w + gap), top, 4, sheet.y - 1.6 * LINE - top)
    scale = sheet.figure.colorbar(image, cax=bar, label="stiffness along the force (N/mm)")
    scale.ax.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    scale.ax.yaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
    scale.ax.yaxis.set_minor_formatter(NullFormatter())
    return sheet.done(LINE)


def _levels(low: float, high: float) -> list[float]:
    """Five to ten round values between."""
    if high / low > 3:
        all_of = [lead * 10.0**e for e in range(-12, 15) for lead in (1, 2, 3, 5, 7)]
    else:
        width = nice_below((high - low) / 5)
        all_of = [width * i for i in range(int(low / width), int(high / width) + 2)]
    return [x for x in all_of if low < x < high] or [0.5 * (low + high)]


def comparison(c: Any, figure: Any = None) -> Any:
    """Measured − predicted of every reading, a panel for each component or sensor, over the band of ±2 standard
    deviations of what noise and tolerances give; at most twelve, those with the largest residuals."""
    table = c.residuals
    channels = list(dict.fromkeys(table["component"]))
    channel, residual = np.array(table["component"]), np.asarray(table["residual"])
    worst = {name: np.abs(residual[channel == name] / np.asarray(table["sigma"])[channel == name]).max()
             for name in channels}
    shown = [name for name in channels if name in sorted(channels, key=lambda n: -worst[n])[:12]]
    rmse = c.content["baseline"]["rmse_mm"]
    sheet = Sheet("Residuals in the order of the file", [f"{c.content['device']} against {c.content['data']}",
                  f"grey: ±2 standard deviations of noise and tolerances; all readings: {1e3 * rmse:.3g} "
                  f"{fine(c.content['unit'])[0]} rms"], figure=figure)
    floors = {c.content["unit"]: c.content["noise_floor_mm"]}
    for i, name in enumerate(shown):
        here = channel == name
        unit = table["unit"][int(np.argmax(here))]
        small, per = fine(unit)
        axes = sheet.below(24 if len(shown) < 5 else 15, LINE)
        band = 2 * floors.get(unit, float(np.median(np.asarray(table["sigma"])[here])))
        axes.axhspan(-band * per, band * per, color=BAND, lw=0)
        axes.axhline(0, color=DARK, lw=0.7)
        axes.plot(np.asarray(table["line"])[here], residual[here] * per, "o", markersize=1.8,
                  color=COLOURS[("x", "y", "z").index(name[-1]) if name[-1] in "xyz" else 0])
        axes.set_ylabel(f"Δ {clip(name, 12)}\n({small})")
        axes.set_xlim(left=0)
        if i + 1 < len(shown):
            axes.set_xticklabels([])
        else:
            axes.set_xlabel("line of the file")
    return sheet.done()


def diagnosis(d: Any, figure: Any = None) -> Any:
    """Probabilities of the leading candidates, of nothing and of an unknown effect; the error before and after."""
    c = d.content
    rows = [(f"{x['effect']}" + (f", {x['site']}" if x["site"].startswith("leg") else ""), x["probability"])
            for x in c["candidates"][:8]]
    rows += [("nothing is missing", c["probability_nothing"]), ("larger tolerances", c["probability_larger_tolerances"]),
             ("an unknown effect", c["probability_unknown"])]
    sheet = Sheet("Which effect is missing", [f"{c['device']} against {c['data']}", c["sentence"]], figure=figure)
    top, h = sheet.y + LINE, 5.0 * len(rows)
    named = set(c["missing"])
    axes = sheet.panel(52, top, 48, h)
    axes.barh(range(len(rows)), [p for _, p in rows], height=0.65,
              color=[ORANGE if name.split(",")[0] in named else COLOURS[0] for name, _ in rows])
    axes.set_yticks(range(len(rows)), [clip(name, 28) for name, _ in rows])
    axes.set_xlim(0, 1)
    axes.invert_yaxis()
    axes.set_xlabel("probability")
    errors = sheet.panel(118, top, sheet.width - 122, h)
    _before_after(errors, c["baseline"], c["final"], c["noise_floor_mm"], c["unit"], ("as it is", "with it"))
    sheet.y = top + h
    return sheet.done(3.4 * LINE)


def _before_after(axes: Any, before: dict, after: dict, floor: float, unit: str, names: tuple[str, str]) -> None:
    """Bars of the error over all poses and of held-out ones; dashed: noise and tolerances."""
    small, per = fine(unit)
    for i, each in enumerate((before, after)):
        axes.bar(i - 0.17, each["rmse_mm"] * per, 0.3, color=COLOURS[0])
        axes.bar(i + 0.17, (each.get("held_out_rmse_mm") or np.nan) * per, 0.3, color=LIGHT[0])
    axes.axhline(floor * per, color=ORANGE, ls="--")
    axes.set_xticks((0, 1), names)
    axes.set_ylabel(f"rms ({small})")
    axes.set_title("light: held-out poses; dashed: noise", fontsize=7, color="#505050", loc="right")


def history(h: Any, figure: Any = None) -> Any:
    """The error of each version over all poses and at held-out poses, and with a placebo in place of its change."""
    c = h.content
    small, per = fine(c["unit"])
    versions = c["versions"]
    sheet = Sheet("The error falling from version to version", [f"measurements {c['data']}"], figure=figure)
    kinds = (("all poses", "rmse_mm", COLOURS[0]), ("held-out poses", "held_out_rmse_mm", LIGHT[0]),
             ("placebo in its place", "placebo_rmse_mm", GREY))
    sheet.legend([(_bar(colour), name) for name, _, colour in kinds]
                 + [(_mark(linestyle="--", color=ORANGE), "noise and tolerances")], 4)
    axes = sheet.below(60, 1.5 * LINE)
    for k, (_, key, colour) in enumerate(kinds):
        axes.bar(np.arange(len(versions)) + 0.26 * (k - 1), [(v[key] or np.nan) * per for v in versions], 0.24,
                 color=colour)
    axes.axhline(versions[-1]["noise_floor_mm"] * per, color=ORANGE, ls="--")
    axes.set_xticks(range(len(versions)), [clip(v["device"], 30) for v in versions])
    axes.set_ylabel(f"rms of measured − predicted ({small})")
    return sheet.done()
