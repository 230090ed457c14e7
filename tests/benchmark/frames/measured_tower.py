#!/usr/bin/env python3
"""Writes a frame of 200 members with eight sensors, and a plan of 200 loads: what `diagnose` is timed on.

  measured_tower.py FRAME.yaml PLAN.csv

A tower of 15 storeys, 400 mm wide and 500 mm high each: four chords and a ring of four rods in every storey, welded;
a diagonal in each wall and one across the storey, every second one mirrored, hinged. The feet are pinned. Each row of
the plan has two or three of six load cases with factors of its own, the same at every call.
"""
import random
import sys

STOREYS, WIDTH, HEIGHT = 15, 400, 500  # mm
CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))


def members():
    """(name, from, to, section, hinged)"""
    for s in range(STOREYS + 1):
        for c in range(4):
            yield f"ring{s}{'abcd'[c]}", (s, c), (s, (c + 1) % 4), "rod", False
    for s in range(STOREYS):
        for c in range(4):
            yield f"chord{s}{'abcd'[c]}", (s, c), (s + 1, c), "chord", False
    for s in range(STOREYS):
        for c in range(4):
            low, high = (c, (c + 1) % 4) if s % 2 else ((c + 1) % 4, c)
            yield f"wall{s}{'abcd'[c]}", (s, low), (s + 1, high), "brace", True
    for s in range(STOREYS + 1):
        yield f"across{s}", (s, s % 2), (s, 2 + s % 2), "brace", True


def node(at):
    return f"n{at[0]}{'abcd'[at[1]]}"


def write_frame(out):
    top, middle = STOREYS, STOREYS // 2
    out.write("name: tower-200\nabout: a tower of 200 members with eight sensors\n"
              "materials: {steel: {E: 210 GPa, nu: 0.3}}\n"
              "sections:\n"
              "  chord: {shape: tube, outer_diameter: 30 mm, inner_diameter: 25 mm}\n"
              "  rod: {shape: tube, outer_diameter: 20 mm, inner_diameter: 16 mm}\n"
              "  brace: {shape: round, diameter: 12 mm}\nnodes:\n")
    for s in range(STOREYS + 1):
        for c, (x, y) in enumerate(CORNERS):
            out.write(f"  {node((s, c))}: [{WIDTH * x} mm, {WIDTH * y} mm, {HEIGHT * s} mm]\n")
    out.write("members:\n")
    for name, a, b, section, hinged in members():
        out.write(f"  {name}: {{from: {node(a)}, to: {node(b)}, section: {section}, material: steel"
                  f"{', truss: true' if hinged else ''}}}\n")
    out.write("supports: {" + ", ".join(f"{node((0, c))}: pinned" for c in range(4)) + "}\n")
    out.write("loads:\n"
              f"  east: {{nodes: {{{node((top, 0))}: {{fx: 1 kN}}, {node((top, 3))}: {{fx: 1 kN}}}}}}\n"
              f"  north: {{nodes: {{{node((top, 0))}: {{fy: 1 kN}}, {node((top, 1))}: {{fy: 1 kN}}}}}}\n"
              f"  down: {{nodes: {{{node((top, 2))}: {{fz: -5 kN}}}}}}\n"
              f"  twist: {{nodes: {{{node((top, 0))}: {{fx: 500 N}}, {node((top, 2))}: {{fx: -500 N}}}}}}\n"
              f"  middle_east: {{nodes: {{{node((middle, 1))}: {{fx: 2 kN}}}}}}\n"
              f"  middle_north: {{nodes: {{{node((middle, 3))}: {{fy: 2 kN}}}}}}\n")
    out.write("sensors:\n"
              f"  top_x: {{node: {node((top, 1))}, direction: ux, sigma: 0.05 mm}}\n"
              f"  top_y: {{node: {node((top, 2))}, direction: uy, sigma: 0.05 mm}}\n"
              f"  middle_x: {{node: {node((middle, 2))}, direction: ux, sigma: 0.02 mm}}\n"
              f"  middle_turn: {{node: {node((middle, 0))}, direction: rz, sigma: 0.05 mrad}}\n"
              "  F_chord: {member: chord0a, force: axial, sigma: 20 N}\n"
              "  F_wall: {member: wall3b, force: axial, sigma: 5 N}\n"
              "  strain: {member: chord7c, strain: {at: 0.5, y: 15 mm, z: 0 mm}, sigma: 1 um/m}\n"
              f"  foot: {{support: {node((0, 1))}, reaction: fz, sigma: 20 N}}\n")
    out.write("tolerances: {modulus: 1 %, load: 0.2 %, node.position: 0.5 mm, member.factor: 1 %}\n")


CASES = ("east", "north", "down", "twist", "middle_east", "middle_north")


def write_plan(out):
    draw = random.Random(7)
    out.write("sequence," + ",".join(f"load.{name}" for name in CASES) + ",top_x_mm\n")
    for row in range(200):
        factors = [0.0] * len(CASES)
        for _ in range(2 + row % 2):
            factors[draw.randrange(len(CASES))] = round(draw.uniform(-1, 1), 2)
        out.write(f"{row + 1}," + ",".join(f"{f:g}" for f in factors) + ",0\n")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], "w") as file:
        write_frame(file)
    with open(sys.argv[2], "w") as file:
        write_plan(file)
