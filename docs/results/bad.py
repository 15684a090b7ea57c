#!/usr/bin/env python3
"""Diagnose, repair and flow every broken or odd file of the corpus, and write the table.

usage: python3 docs/results/bad.py [CORPUS [NAME…]] > docs/results/bad.md     (after: cargo build --release -p ricci-apps)
"""
import math
import os

from page import corpus_of, index, launch, main, named, table

MORE = 1000
LARGE = 1000
CORPUS = corpus_of("bad")


def finite(value):
    if isinstance(value, dict):
        return all(map(finite, value.values()))
    if isinstance(value, list):
        return all(map(finite, value))
    return not isinstance(value, float) or math.isfinite(value)


def checked(run, *line):
    """Exit code, report and stderr; a panic or an exit code of no meaning ends the script."""
    code, report, error = launch(run.folder, *line)
    assert code in (0, 1, 3) and "panick" not in error, (line, code, error)
    assert report is None or finite(report), line
    return code, report, error


def failing(run, name, clean, result):
    """What the report of a flow says that did not reach its target, and what more steps give."""
    _, more, _ = checked(run, "flow", clean, "--max-iterations", str(MORE))
    again, worst, shape = more["result"], result["worst_vertices"][0], more["input"]
    floor = f", rounding floor {again['rounding_floor']:.0e}" if again["rounding_floor"] else ""
    return (name, f"{shape['vertices']}, {shape['genus']}, {shape['boundary_loops']}", result["stop_reason"], result["flips"],
            f"{result['max_curvature_error']:.1e} at vertex {worst['vertex']}",
            f"{again['area_ratio_min']:.0e} … {again['area_ratio_max']:.0e}" if again["area_ratio_min"] else "–",
            f"{again['stop_reason']} after {again['iterations']}: {again['max_curvature_error']:.0e}{floor}")


def kinds(result):
    return ", ".join(f"{d['code']} {d['count']}" for d in result["defect_counts"]) or "none"


class Totals:
    """What is summed up over the files."""
    fails, flows, share, flow_bytes = [], 0, 0.0, 0.0


def row(run, file):
    path = os.path.join(CORPUS, file["file"])
    limit = (64 << 20) + 20 * os.path.getsize(path)
    code, report, error = checked(run, "info", path)
    codes = [code]
    if report is None or "error" in report["result"]:
        return file["file"], error.split(": ", 2)[-1][:90], "–", "–", "3"
    Totals.share = max(Totals.share, report["peak_bytes"] / limit)
    found, left, flow, clean = kinds(report["result"]), "–", "–", run.path("clean.ply")
    code, report, error = checked(run, "repair", path, "-o", clean, "--cut-edges", *(["--component", "0"] if report["input"]["faces"] else []))
    codes.append(code)
    if report and "error" not in report["result"]:
        Totals.share = max(Totals.share, report["peak_bytes"] / limit)
        left = kinds(report["result"])
    if code == 0:
        code, report, error = checked(run, "flow", clean)
        codes.append(code)
        if report["input"]["faces"] >= LARGE:
            Totals.flow_bytes = max(Totals.flow_bytes, report["peak_bytes"] / report["input"]["faces"])
        if not report["result"]["converged"]:
            Totals.fails.append(failing(run, file["file"], clean, report["result"]))
        flow = f"{report['result']['stop_reason']}, {report['result']['iterations']} steps"
        Totals.flows += report["result"]["converged"]
    return file["file"], found, left, flow, " ".join(map(str, codes))


def content(run):
    files = [file for file in index(CORPUS) if not named or file["file"] in named]
    rows = run.rows(files, row)
    fails = [] if not Totals.fails else [
        "## Flows that did not",
        f"Error: max |K − K̄|. Area: least and largest ratio of area in the layout to area on the surface, and the end of the flow, with "
        f"`--max-iterations {MORE}` instead of 200.",
        table(["file", "vertices, genus, loops", "why", "flips", "error", "area", "more steps"], Totals.fails),
        "Lengths change there by factors as far apart as the square roots of the ratios: far for Newton's steps from u = 0, "
        "with many flips on the way, and with few digits left where they shrink most.",
    ]
    return [
        "# Broken and odd files",
        f"Made by `docs/results/bad.py`: `ricci info`, `ricci repair --cut-edges --component 0`, and `ricci flow` of the result where it is "
        f"admissible, on each of the {len(files)} files. Every run ended with exit code 0, 1 or 3, without a panic, with finite numbers in its "
        f"report. `info` and `repair` took at most {100 * Totals.share:.0f} % of 64 MB + 20 × the file; a flow with its layout "
        f"took at most {Totals.flow_bytes / 1000:.0f} kB per face (of surfaces with {LARGE} faces or more).",
        f"Flows that reached their target, with flips as is the default: {Totals.flows} of {sum(r[3] != '–' for r in rows)}.",
        *fails,
        "## All files",
        table(["file", "defects (or why it is refused)", "left after repair", "flow", "exit codes"], rows),
    ]


main(content)
