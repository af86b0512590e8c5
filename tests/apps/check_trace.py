#!/usr/bin/env python3
"""Checks a trace of `weft run --trace`: every thread named, events nested, chunks inside of their law.

usage: check_trace.py TRACE.json LAW
"""
import json
import sys


def faults(trace, law):
    events = trace["traceEvents"]
    names = {e["tid"]: e["args"]["name"] for e in events if e["ph"] == "M" and e["name"] == "thread_name"}
    work = [e for e in events if e["ph"] == "X"]
    if "main" not in names.values():
        yield f"no thread 'main' among {sorted(names.values())}"
    if len(set(names.values())) != len(names):
        yield f"thread names are not unique: {sorted(names.values())}"
    for e in work:
        if e["tid"] not in names:
            yield f"thread {e['tid']} has no name"
        if e["ts"] < 0 or e["dur"] < 0:
            yield f"negative time in {e}"
    in_nanoseconds = lambda e: (round(e["ts"] * 1000), round((e["ts"] + e["dur"]) * 1000))
    for tid in names:
        open_ends = []
        for begin, end in sorted((in_nanoseconds(e) for e in work if e["tid"] == tid), key=lambda t: (t[0], -t[1])):
            while open_ends and open_ends[-1] <= begin:
                open_ends.pop()
            if open_ends and end > open_ends[-1]:
                yield f"an event of thread '{names[tid]}' ends after the one around it, at {end} ns"
            open_ends.append(end)
    laws = [in_nanoseconds(e) for e in work if e["name"] == law]
    chunks = [in_nanoseconds(e) for e in work if e["name"] == "chunk"]
    if not laws or not chunks:
        yield f"{len(laws)} events '{law}' and {len(chunks)} chunks, expected some of both"
    inside = sum(any(a <= begin and end <= b for a, b in laws) for begin, end in chunks)
    if inside < len(laws):
        yield f"{inside} chunks inside of {len(laws)} events '{law}', expected at least one in each"


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        found = list(faults(json.load(file), sys.argv[2]))
    print("\n".join(found[:10]))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
