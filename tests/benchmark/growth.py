#!/usr/bin/env python3
"""How `compare` and `diagnose` grow with the data: wall time in s and peak memory in MB over readings and poses, and the
exponent p of time ∝ readings^p between the two largest sets of each row of sets (1: cost that grows as the data).

  tests/benchmark/growth.py --program build/deflect [--largest 7200] [--json FILE] [--figure FILE.svg]

Sets: 48 readings a pose (24 loads, twice) at 15, 60, 150, … poses; one pose label a reading; 15 poses with ever more
readings. --largest leaves out sets with more readings than that. The figure is drawn where gnuplot is.
"""
import argparse
import csv
import json
import math
import pathlib
import shutil
import subprocess
import tempfile

from commands import run

DEVICE = "haptic-6psu-ideal-joints"
POSE = "x_mm y_mm z_mm roll_deg pitch_deg yaw_deg".split()
LOAD = "fx_N fy_N fz_N mx_Nmm my_Nmm mz_Nmm".split()
ROWS = {
    "48 readings a pose": [(720, 15), (2880, 60), (7200, 150), (28800, 600)],
    "one label a reading": [(240, 240), (720, 720), (2880, 2880)],
    "15 poses": [(7200, 15), (28800, 15), (100000, 15)],
}


def poses_of(program, folder, count):
    """Poses that the device can take: those of random campaigns."""
    found, seed = {}, 0
    while len(found) < count:
        seed += 1
        file = folder / "poses.csv"
        run([program, "simulate", DEVICE, "--campaign", "random", "--geometry", "linear", "--elements", "1", "--seed",
             str(seed), "-o", str(file)])
        with open(file) as rows:
            for row in csv.DictReader(rows):
                found.setdefault((seed, row["pose"]), [row[name] for name in POSE])
    return list(found.values())[:count]


def loads():
    out = []
    for axis in range(6):
        for share in (-1, -0.5, -0.2, 0.2, 0.5, 1) if axis < 3 else (-1, 1):
            load = [0.0] * 6
            load[axis] = share * (50 if axis < 3 else 1000)
            out.append(load)
    return out


def make(program, folder, poses, readings):
    """A set with a compliance hidden in it; what costs is its size, so that the linear geometry will do."""
    plan, data = folder / "plan.csv", folder / "data.csv"
    all_loads = loads()
    with open(plan, "w") as file:
        out = csv.writer(file)
        out.writerow(["pose", *POSE, "sequence", *LOAD])
        for i in range(readings):
            pose = i // len(all_loads) % len(poses) if len(poses) < readings else i
            out.writerow([f"p{pose}", *poses[pose], i, *all_loads[i % len(all_loads)]])
    run([program, "simulate", DEVICE, "--with", "guide_root_compliance,stiffness_Nmm_per_rad=5e6", "--seed", "7",
         "--campaign", str(plan), "--geometry", "linear", "--elements", "1", "-o", str(data)])
    return str(data)


def exponent(measured, key):
    if len(measured) < 2:
        return None
    a, b = measured[-2:]
    return math.log(b[key] / a[key]) / math.log(b["readings"] / a["readings"])


def draw(results, file):
    """Time over readings, both logarithmic; dashed: in proportion."""
    commands = ["compare", "diagnose"]
    script = ["set terminal svg size 720,440 font 'sans,13'", f"set output '{file}'", "set logscale xy",
              "set xlabel 'readings'", "set ylabel 'wall time, s'", "set key left top", "set grid"]
    curves, data = [], []
    for row, measured in results.items():
        for command in commands:
            name = f"$d{len(data)}"
            data.append((name, [(m["readings"], m[command]["wall_s"]) for m in measured]))
            curves.append(f"{name} with linespoints title '{command}, {row}'")
    for name, points in data:
        script += [f"{name} << E", *(f"{x} {y}" for x, y in points), "E"]
    script.append("plot " + ", ".join(curves + ["x/1e3 dashtype 2 linecolor 'gray' title 'in proportion'"]))
    subprocess.run(["gnuplot"], input="\n".join(script) + "\n", text=True, check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--largest", type=int, default=7200)
    parser.add_argument("--json")
    parser.add_argument("--figure")
    asked = parser.parse_args()
    rows = {name: [s for s in sets if s[0] <= asked.largest] for name, sets in ROWS.items()}
    rows = {name: sets for name, sets in rows.items() if sets}
    results = {}
    print(f"{'readings':>9} {'poses':>6} {'compare s':>10} {'MB':>6} {'diagnose s':>11} {'MB':>6}")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        poses = poses_of(asked.program, folder, max(s[1] for sets in rows.values() for s in sets))
        for row, sets in rows.items():
            results[row] = []
            for readings, count in sets:
                data = make(asked.program, folder, poses[:count], readings)
                measured = {"readings": readings, "poses": count}
                for command in ("compare", "diagnose"):
                    wall, cpu, memory = run([asked.program, command, DEVICE, data])
                    measured[command] = {"wall_s": wall, "cpu_s": cpu, "peak_MB": memory}
                results[row].append(measured)
                c, d = measured["compare"], measured["diagnose"]
                print(f"{readings:9} {count:6} {c['wall_s']:10.2f} {c['peak_MB']:6.0f} {d['wall_s']:11.2f} "
                      f"{d['peak_MB']:6.0f}", flush=True)
            for command in ("compare", "diagnose"):
                flat = [{"readings": m["readings"], "cpu": m[command]["cpu_s"]} for m in results[row]]
                if (p := exponent(flat, "cpu")) is not None:
                    print(f"  {row}: processor time of {command} grows as readings^{p:.2f}")
    if asked.json:
        pathlib.Path(asked.json).write_text(json.dumps(results, indent=1) + "\n")
    if asked.figure and shutil.which("gnuplot"):
        draw(results, asked.figure)


if __name__ == "__main__":
    main()
