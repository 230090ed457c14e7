#!/usr/bin/env python3
"""Writes a cubic lattice frame: n^3 nodes 100 mm apart, nearest neighbours joined by rods d = 6 mm (E 210 GPa, nu 0.3,
Euler-Bernoulli), bottom face clamped, 1 N in x and -1 N in z on each top node.

  lattice.py frame N FILE.yaml      a frame file of deflect
  lattice.py calculix N FILE.inp    the same with user beams U1 (a shear coefficient of 1e9 makes them Euler-Bernoulli)

CalculiX answers for comparing time, not displacements: U1 of CalculiX 2.20 couples the ends of a beam wrongly in one of
its two planes. A cantilever of one element is right; of two in line it is right in the plane of the section's first axis
and deflects by -0.014 of what it should in the other. The corner of a lattice comes out 0.2 to 0.9 % off.
"""
import math
import sys

DIAMETER, SPACING, YOUNG, POISSON = 6.0, 100.0, 210e3, 0.3  # mm, MPa
DIRECTIONS = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
SECTION_AXES = ((0, 1, 0), (1, 0, 0), (1, 0, 0))  # of CalculiX: the corner comes nearest with these


def node(n, x, y, z):
    return (z * n + y) * n + x


def nodes(n):
    """(x, y, z) by number."""
    return [(x, y, z) for z in range(n) for y in range(n) for x in range(n)]


def rods(n, direction):
    """Pairs of node numbers."""
    for x, y, z in nodes(n):
        far = (x + direction[0], y + direction[1], z + direction[2])
        if max(far) < n:
            yield node(n, x, y, z), node(n, *far)


def write_frame(n, out):
    out.write(f"name: lattice-{n}\n"
              f"materials: {{steel: {{E: {YOUNG / 1e3:g} GPa, nu: {POISSON}}}}}\n"
              f"sections: {{rod: {{shape: round, diameter: {DIAMETER:g} mm}}}}\n"
              "nodes:\n")
    for i, p in enumerate(nodes(n)):
        x, y, z = (SPACING * c for c in p)
        out.write(f"  n{i}: [{x:g} mm, {y:g} mm, {z:g} mm]\n")
    out.write("members:\n")
    number = 0
    for direction in DIRECTIONS:
        for a, b in rods(n, direction):
            out.write(f"  m{number}: {{from: n{a}, to: n{b}, section: rod, material: steel}}\n")
            number += 1
    out.write("supports:\n")
    for i in range(n * n):
        out.write(f"  n{i}: clamped\n")
    out.write("loads:\n  top:\n    nodes:\n")
    for i in range(n ** 3 - n * n, n ** 3):
        out.write(f"      n{i}: {{fx: 1 N, fz: -1 N}}\n")


def write_calculix(n, out):
    area, second = math.pi * DIAMETER ** 2 / 4, math.pi * DIAMETER ** 4 / 64
    out.write("*NODE, NSET=all\n")
    for i, p in enumerate(nodes(n)):
        x, y, z = (SPACING * c for c in p)
        out.write(f"{i + 1}, {x:g}, {y:g}, {z:g}\n")
    out.write("*USER ELEMENT, TYPE=U1, NODES=2, INTEGRATION POINTS=2, MAXDOF=6\n")
    number = 1
    for k, direction in enumerate(DIRECTIONS):
        out.write(f"*ELEMENT, TYPE=U1, ELSET=along{k}\n")
        for a, b in rods(n, direction):
            out.write(f"{number}, {a + 1}, {b + 1}\n")
            number += 1
    out.write(f"*MATERIAL, NAME=steel\n*ELASTIC\n{YOUNG:g}, {POISSON}\n")
    for k in range(3):
        one = SECTION_AXES[k]
        out.write(f"*BEAM SECTION, ELSET=along{k}, MATERIAL=steel, SECTION=GENERAL\n"
                  f"{area:.12g}, {second:.12g}, 0., {second:.12g}, 1e9\n{one[0]}., {one[1]}., {one[2]}.\n")
    out.write("*NSET, NSET=bottom, GENERATE\n" f"1, {n * n}\n"
              "*NSET, NSET=top, GENERATE\n" f"{n ** 3 - n * n + 1}, {n ** 3}\n"
              "*NSET, NSET=corner\n" f"{n ** 3 - n * n + 1}\n"
              "*BOUNDARY\nbottom, 1, 6\n*STEP\n*STATIC\n*CLOAD\ntop, 1, 1.\ntop, 3, -1.\n"
              "*NODE PRINT, NSET=corner\nU\n*END STEP\n")


if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] not in ("frame", "calculix"):
        sys.exit(__doc__)
    with open(sys.argv[3], "w") as file:
        (write_frame if sys.argv[1] == "frame" else write_calculix)(int(sys.argv[2]), file)
