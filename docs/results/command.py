#!/usr/bin/env python3
"""Where the time of a whole command goes, with one thread and with two; writes the page.

usage: docs/results/command.py [CORPUS [NAME…]] > docs/results/command.md     (after: tests/release)
"""
import os
import platform
import statistics
import subprocess

import page

# Tori of revolution by the number of segments around the axis, where the metric is changed without flips and with them.
TORI = [(326, 163), (652, 326), (1304, 652)]
# Meshes of 3,500 to 10,500 vertices, in the plane and in the hyperbolic plane.
SMALL = ["eight_3498", "fertility_4494", "bob", "kitten_10k", "rocker_arm", "cup_10k", "chair_10k"]
FLOW = ["assemble", "analyse", "factor", "solve", "flip"]
PHASES = ["read", "build", *FLOW, "refine", "layout", "write"]
# Runs of each command, of which medians are taken; the numbers of threads follow each other, so that what else the machine does hits both.
RUNS = 5


def reports(run, mesh, *options):
    """Reports of the command by number of threads."""
    found = {1: [], 2: []}
    for _ in range(RUNS):
        for threads, rows in found.items():
            (metric,) = run.fresh("metric.json")
            rows.append(run.needed(mesh, "flow", mesh, *options, "--threads", str(threads), "--metric", metric))
    return found


def rows(name, found):
    """A row of the table for each number of threads."""
    middle = {t: {p: statistics.median(r["seconds"][p] for r in rows) for p in [*PHASES, "total"]} for t, rows in found.items()}
    for threads, rows in found.items():
        seconds, (vertices, faces) = middle[threads], (rows[0]["input"][k] for k in ("vertices", "faces"))
        flow = sum(seconds[p] for p in FLOW)
        faster = f"{middle[1]['total'] / seconds['total']:.2f}" if threads > 1 else ""
        over = f"{seconds['total'] / flow:.2f}" if threads == 1 else ""
        cells = [f"{seconds[p]:.3f}" for p in PHASES] + [f"{flow:.3f}", f"{seconds['total']:.3f}", over, faster]
        layout, memory = 1e6 * seconds["layout"] / faces, max(r["peak_bytes"] for r in rows) / vertices
        yield [name, vertices, rows[0]["result"]["flips"], threads, *cells, f"{layout:.2f}", f"{memory:.0f}"]


def content(run):
    out = []
    for n, m in [] if page.named else TORI:
        torus = run.make("torus.obj", "torus", "--big", "2", "--small", "0.9", "-n", str(n), "-m", str(m))
        out += rows("torus, `--flips never`", reports(run, torus, "--flips", "never"))
        out += rows("torus", reports(run, torus))
    for mesh in page.meshes(lambda m: m["name"] in SMALL):
        out += rows(f"{mesh['name']} (genus {mesh['genus']})", reports(run, page.file_of(mesh)))
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=page.root, capture_output=True, text=True).stdout.strip()
    head = ["surface", "vertices", "flips", "threads", *PHASES, "flow", "whole", "whole over flow", "times one thread", "layout, µs per face", "bytes per vertex"]
    return [f"""# Where the time of a command goes

Made by `docs/results/command.py > docs/results/command.md` with the command of commit {commit}, on {platform.machine()} with {os.cpu_count()} cores; the load average
of the minute before it ended was {os.getloadavg()[0]:.1f}.

`ricci flow MESH --metric M.json --report R.json --threads N`, medians of {RUNS} runs, seconds as the reports say them. `flow` is the sum of {", ".join(FLOW)}; flip has the
flow's start; on two threads the analysis is made beside that and counts in both. `whole` is the whole command without the report itself; it is more than the sum, since the measurements that the report asks for and the making
of the target belong to no phase, and less with two threads, where the metric is written and measured beside the layout. Bytes are the most memory that the process
had, the program's own 11 MB among them.

{page.table(head, out)}"""]


page.main(content)
