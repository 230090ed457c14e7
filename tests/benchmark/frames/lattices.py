#!/usr/bin/env python3
"""Lattice frames by deflect, by bare CHOLMOD and, where it is installed, by CalculiX (ccx), in turns on one machine.

  cmake --build build --target benchmarks
  tests/benchmark/frames/lattices.py --sizes 10 20 30 --repeats 5 --json build/lattices.json

Each figure is of a whole process: wall time, and peak memory as the kernel counts it; of deflect also without reading the
file; of bare CHOLMOD also analyse + factor + solve alone, which is what ratios are taken to. Medians; ratios are medians of the ratios within a turn, so that
what else the machine does meets both sides. A turn runs every program once.
"""
import argparse
import json
import os
import pathlib
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
import lattice  # noqa: E402


def run(command, folder, environment):
    """Wall seconds, CPU seconds, peak MB and standard output of a whole process."""
    out = folder / "out.txt"
    start = time.monotonic()
    with open(out, "w") as file:
        process = subprocess.Popen(command, cwd=folder, stdout=file, stderr=subprocess.STDOUT,
                                   env={**os.environ, **environment})
        _, status, usage = os.wait4(process.pid, 0)
    wall = time.monotonic() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    text = out.read_text(errors="replace")
    if process.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} failed:\n{text[-2000:]}")
    return {"wall_s": wall, "cpu_s": usage.ru_utime + usage.ru_stime, "peak_MB": usage.ru_maxrss / 1024, "out": text}


def corner_of(n, json_file):
    """Displacements of the node (0, 0, top) in mm from deflect's result."""
    rows = json.loads(json_file.read_text())["cases"]["top"]["displacements"]
    return [rows[n ** 3 - n * n][key] for key in ("ux_mm", "uy_mm", "uz_mm")]


def programs_of(n, options, folder):
    """Name: command, environment, for those that are wanted at this size."""
    deflect, bare = options.build / "deflect", options.build / "bare_cholmod"
    found = {"deflect": ([deflect, "frame", "frame.yaml", "--verbose"], {})}
    if n <= options.direct_up_to:
        found["deflect --solver direct"] = ([deflect, "frame", "frame.yaml", "--solver", "direct", "--verbose"], {})
        subprocess.run([bare, "write", "frame.yaml", "matrix.bin"], cwd=folder, check=True)
        found["bare CHOLMOD"] = ([bare, "solve", "matrix.bin", str(options.blas_threads)], {})
    if options.ccx and n <= options.ccx_up_to:
        with open(folder / "frame.inp", "w") as file:
            lattice.write_calculix(n, file)
        found["CalculiX"] = ([options.ccx, "frame"], {"OMP_NUM_THREADS": str(os.cpu_count())})
    return found


def measure(n, options, folder):
    with open(folder / "frame.yaml", "w") as file:
        lattice.write_frame(n, file)
    programs = programs_of(n, options, folder)
    runs = {name: [] for name in programs}
    for _ in range(options.repeats):
        for name, (command, environment) in programs.items():
            result = run(command, folder, environment)
            text = result.pop("out")
            if name == "bare CHOLMOD":
                result.update(json.loads(text))
            else:
                result["total_s"] = result["wall_s"]
            if name.startswith("deflect"):
                result["solver"] = re.search(r"solver: (.*)", text)[1]
                result["reading_s"] = float(re.search(r"frame: reading: ([\d.]+) s", text)[1])
            runs[name].append(result)
    rows = {}
    reference = "bare CHOLMOD" if "bare CHOLMOD" in runs else "deflect"
    for name, results in runs.items():
        keys = [key for key, value in results[0].items() if not isinstance(value, str)]
        rows[name] = {key: statistics.median(r[key] for r in results) for key in keys}
        rows[name]["time_ratio"] = statistics.median(
            r["total_s"] / other["total_s"] for r, other in zip(results, runs[reference]))
        if "reading_s" in rows[name]:
            rows[name]["time_ratio_without_reading"] = statistics.median(
                (r["total_s"] - r["reading_s"]) / other["total_s"] for r, other in zip(results, runs[reference]))
        rows[name]["memory_ratio"] = rows[name]["peak_MB"] / statistics.median(r["peak_MB"] for r in runs[reference])
        rows[name].update({key: value for key, value in results[0].items() if isinstance(value, str)})
    run([options.build / "deflect", "frame", "frame.yaml", "--json", "result.json"], folder, {})
    rows["deflect"]["corner_mm"] = corner_of(n, folder / "result.json")
    return {"nodes": n ** 3, "free_freedoms": 6 * n * n * (n - 1), "ratios_to": reference, "programs": rows}


def version(command):
    text = subprocess.run(command, capture_output=True, text=True).stdout
    return " ".join(text.split())


def machine():
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return {"cpu": model[1] if model else platform.machine(), "cores": os.cpu_count(),
            "memory_GB": round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9, 1),
            "system": platform.platform(), "load_at_start": os.getloadavg()}


def main():
    root = pathlib.Path(__file__).resolve().parents[3]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", default=[10, 20, 30], help="nodes along an edge")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--build", type=lambda p: pathlib.Path(p).resolve(), default=root / "build")
    parser.add_argument("--blas-threads", type=int, default=os.cpu_count(), help="of bare CHOLMOD; deflect: all")
    parser.add_argument("--direct-up-to", type=int, default=30, help="size up to which is factorised")
    parser.add_argument("--ccx", default=shutil.which("ccx"), help="CalculiX; left out where there is none")
    parser.add_argument("--ccx-up-to", type=int, default=20)
    parser.add_argument("--json", type=pathlib.Path, help="where the result goes")
    options = parser.parse_args()
    result = {"machine": machine(), "versions": {"deflect": version([options.build / "deflect", "--version"])},
              "results": {}}
    if options.ccx:
        result["versions"]["CalculiX"] = version([options.ccx, "-v"])
    for n in options.sizes:
        with tempfile.TemporaryDirectory() as folder:
            result["results"][str(n)] = measured = measure(n, options, pathlib.Path(folder))
        print(f"{n}^3 nodes, {measured['free_freedoms']} free freedoms, ratios to {measured['ratios_to']}")
        print(f"  {'':24} {'wall s':>8} {'CPU s':>8} {'solve s':>8} {'time':>6} {'unread':>6} {'peak MB':>9} {'memory':>7}")
        for name, row in measured["programs"].items():
            print(f"  {name:24} {row['wall_s']:8.2f} {row['cpu_s']:8.2f} {row['total_s']:8.2f} {row['time_ratio']:6.2f} "
                  f"{row.get('time_ratio_without_reading', row['time_ratio']):6.2f} {row['peak_MB']:9.0f} {row['memory_ratio']:7.2f}  {row.get('solver', '')}", flush=True)
        print("  corner (0, 0, top): " + ", ".join(f"{u:.9g}" for u in measured["programs"]["deflect"]["corner_mm"]), "mm")
    if options.json:
        options.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
