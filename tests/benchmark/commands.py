#!/usr/bin/env python3
"""Whole commands, each run several times: median wall and processor time, seconds, and peak memory, MB; some of them
under mpirun, where it is installed; and, where chromium-headless-shell is, when the page of a diagnosis is ready for use, counted from its opening.

  tests/benchmark/commands.py --program build/deflect [--repeats 5] [--json FILE]
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
import tempfile
import time

DEVICE = "haptic-6psu-ideal-joints"


def cases(program, folder):
    """(name, words, runs before it that are not timed)"""
    data = str(folder / "hidden.csv")
    hidden = [program, "simulate", DEVICE, "--with", "guide_root_compliance,stiffness_Nmm_per_rad=5e6", "--seed", "7",
              "-o", data]
    page = str(folder / "page.html")
    small, large = ([program, "map", "haptic-6psu", "--n", n, "--threads"] for n in ("21,21,21", "41,41,41"))
    diagnose = [program, "diagnose", DEVICE, data]
    many = diagnose + ["--bootstrap", "1000000", "--threads"]
    found = [
        ("solve", [program, "solve", "haptic-6psu", "--pose", "25,25,198.9", "--load", "50,0,0"], []),
        ("validate", [program, "validate", "haptic-6psu"], []),
        ("map, 9261 poses, both theories, one thread", small + ["1"], []),
        ("map, 9261 poses, both theories, two threads", small + ["2"], []),
        ("map, 68921 poses, both theories, one thread", large + ["1"], []),
        ("map, 68921 poses, both theories, two threads", large + ["2"], []),
        ("simulate, 720 readings", hidden, []),
        ("compare, 720 readings", [program, "compare", DEVICE, data], [hidden]),
        ("diagnose, 720 readings, whole catalogue", diagnose, [hidden]),
        ("diagnose with its page", diagnose + ["--report", page], [hidden]),
        ("diagnose, bootstrap of 10^6, one thread", many + ["1"], [hidden]),
        ("diagnose, bootstrap of 10^6, two threads", many + ["2"], [hidden]),
    ]
    if shutil.which("mpirun"):
        two = ["mpirun", "-n", "2", "--oversubscribe"] + ["--allow-run-as-root"] * (os.geteuid() == 0)
        found += [("map, 68921 poses, two processes", two + large + ["1"], []),
                  ("diagnose, bootstrap of 10^6, two processes", two + many + ["1"], [hidden])]
    return found


def run(words):
    """Wall and processor time in s, peak memory in MB."""
    begun = time.perf_counter()
    child = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    errors = child.stderr.read()
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        raise SystemExit(f"{' '.join(words)} ended with {child.returncode}: {errors.decode()}")
    return time.perf_counter() - begun, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def page_ready(folder):
    """Seconds from opening the page to its first drawn frame, as the page itself counts; None without a browser."""
    browser = shutil.which("chromium-headless-shell")
    if not browser:
        return None
    options = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
               "--timeout=10000", "--dump-dom"]
    shown = subprocess.run([browser, *options, f"file://{folder}/page.html"], capture_output=True, text=True, check=True)
    found = re.search('data-ready="([0-9]+)"', shown.stdout)
    if not found:
        raise SystemExit("the page was not ready within 10 s")
    return int(found[1]) / 1e3


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--json")
    asked = parser.parse_args()
    results = []
    print(f"{'command':48} {'wall s':>8} {'cpu s':>8} {'MB':>7}")
    with tempfile.TemporaryDirectory() as folder:
        for name, command, before in cases(asked.program, pathlib.Path(folder)):
            for words in before:
                run(words)
            runs = [run(command) for _ in range(asked.repeats)]
            wall, cpu, memory = (statistics.median(column) for column in zip(*runs))
            results.append({"command": name, "words": command, "wall_s": wall, "cpu_s": cpu, "peak_MB": memory})
            print(f"{name:48} {wall:8.3f} {cpu:8.3f} {memory:7.0f}", flush=True)
        ready = [r for r in (page_ready(folder) for _ in range(asked.repeats)) if r is not None]
        if ready:
            results.append({"command": "page ready in a browser", "wall_s": statistics.median(ready)})
            print(f"{'page ready in a browser':48} {statistics.median(ready):8.3f}")
    if asked.json:
        machine = {"system": platform.platform(), "processors": os.cpu_count(), "processor": processor()}
        pathlib.Path(asked.json).write_text(
            json.dumps({"machine": machine, "repeats": asked.repeats, "results": results}, indent=1) + "\n")


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


if __name__ == "__main__":
    main()
