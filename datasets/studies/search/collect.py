#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The libscan authors
# SPDX-License-Identifier: Apache-2.0
"""Error and seconds of every run of a finished grid: collect.py STUDY.json OUT > grid.json

OUT is the folder that `scan tradeoff STUDY.json OUT` wrote. A stage's seconds are the least of the
seeds, and reconstruction's the least of the alignment methods, too: what else the machine did in the
meantime only ever adds to them.
"""
import itertools
import json
import sys

recipe, folder = sys.argv[1:3]
study = json.load(open(recipe))["tradeoff"]
keys = [v["key"] for v in study["vary"]]
lists = [v["values"] for v in study["vary"]]
seeds = range(study["seeds"])
settings = list(itertools.product(*[range(len(values)) for values in lists]))


def shared_by(setting, stage):
    """What decides the stage's seconds."""
    parts = {"align": ("align",), "reconstruct": ("reconstruct",)}.get(stage, ())
    return stage, tuple(
        i for i, key in zip(setting, keys)
        if key.startswith(parts) or not key.startswith(("align", "reconstruct")))


least, outcomes = {}, {}
for setting, seed in itertools.product(settings, seeds):
    name = "".join(f"{i}-" for i in setting) + f"seed{seed}"
    outcome = json.load(open(f"{folder}/runs/{name}/outcome.json"))
    outcomes[setting, seed] = outcome
    for stage, cost in outcome["stages"].items():
        key = shared_by(setting, stage)
        least[key] = min(least.get(key, cost["seconds"]), cost["seconds"])

runs = []
for setting in settings:
    seconds = [sum(least[shared_by(setting, stage)] for stage in outcomes[setting, s]["stages"])
               for s in seeds]
    runs.append({"settings": {k: v[i] for k, v, i in zip(keys, lists, setting)},
                 "by_seed": {"error_m": [outcomes[setting, s]["error"] for s in seeds],
                             "seconds": [round(s, 4) for s in seconds]}})
print('{"runs": [\n' + ",\n".join(json.dumps(run) for run in runs) + "\n]}")
