#!/usr/bin/env python3
"""Prints the failed checks of a report.json as rows of validation/deviations/deviation_table.cpp.

A row belongs under the cause that explains it, which only a person can tell: the rows come by engine and case.

    tools/state_deviations.py weft-report/report.json
"""

import json
import math
import sys


def number(value):
    """A C++ literal; what is no number is stated as infinity."""
    value = float(value)
    return f"{value:.3g}" if math.isfinite(value) else "kInfinity"


def literal(text):
    return json.dumps(text, ensure_ascii=False)


def rows(report):
    for check in report["checks"]:
        if check["verdict"] in ("fail", "known"):
            yield check["engine"], check["case"], "        {%s, %s, %s, %s, %s}," % (
                literal(check["case"]),
                literal(check["engine"]),
                literal(check["claim"]),
                literal(check["metric"]),
                number(check["measured"]),
            )


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        report = json.load(file)
    for _, _, row in sorted(rows(report)):
        print(row)


if __name__ == "__main__":
    main()
