#!/usr/bin/env python3
"""Golden vectors: small surfaces and splines, computed with 60 digits or exactly, and by nothing of the project.

usage: tests/vectors/make.py DIRECTORY [CAPABILITY…]      (needs mpmath; the tests do not: they read the files that are committed)

README.md beside this file says what the files hold, what each case checks and where its numbers come from.
"""
import sys

import formula_cases
import map_cases
import metric_cases
from cases import write
from discrete import Random


def main():
    folder = sys.argv[1]
    wanted = sys.argv[2:]
    flow = []

    def both():
        flow.extend(metric_cases.flows(Random(2007)))
        return flow[0]

    all_cases = {
        "flow": both,
        "cones": lambda: metric_cases.cones(Random(3)),
        "layouts": lambda: metric_cases.layouts(Random(5)),
        "uniformization": lambda: metric_cases.uniformizations(Random(11)),
        "groups": lambda: metric_cases.groups(Random(13)),
        "circle_domains": lambda: map_cases.circle_domains(Random(17)),
        "harmonic": lambda: map_cases.harmonics(Random(19)),
        "forms": lambda: map_cases.form_cases(Random(23)),
        "atlases": lambda: map_cases.atlases(Random(29)) + map_cases.round_atlases(),
        "splines": lambda: map_cases.splines() + map_cases.surfaces_fitted(),
        "matching": lambda: map_cases.matchings(Random(31)),
        "triangles": formula_cases.triangles,
        "circle_patterns": lambda: formula_cases.circle_patterns(Random(1985)),
        "derivative": lambda: (flow or metric_cases.flows(Random(2007)))[1],
    }
    for capability, make in all_cases.items():
        if not wanted or capability in wanted:
            write(folder, capability, make())


main()
