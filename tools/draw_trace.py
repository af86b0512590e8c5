#!/usr/bin/env python3
"""Draws a trace (Chrome's trace event format, as `weft run --trace` writes it) as an SVG picture.

usage: draw_trace.py TRACE.json PICTURE.svg [--title TEXT] [--from-ms T] [--to-ms T]

One lane per thread, time to the right; what happens inside of something else is drawn below it.
"""
import argparse
import json
import sys
from html import escape

WIDTH = 960
LEFT, RIGHT, TOP = 84, 16, 40
BAR = 15  # height of an event
GAP = 14  # between threads
THIN = 3  # an event of fewer pixels has no rim, or nothing but the rim would be seen
FONT = 'font-family="DejaVu Sans, Arial, sans-serif"'

# Colours that also differ in lightness, so that they survive a grey print.
COLORS = {
    "other work": "#d9d9d9",
    "frame": "#f4f4f4",
    "forces": "#b8d4e8",
    "deferred forces": "#b8d4e8",
    "begin forces": "#e8a33d",
    "finish forces": "#f2c879",
    "wait for forces": "#c0392b",
    "chunk": "#1f6fa8",
    "join": "#0b3c5d",
}
OTHER_COLORS = ["#7fb58f", "#8f7fb5", "#b57f8f", "#5f9ea0", "#a0905f"]
IN_LEGEND_LAST = ("chunk", "join", "other work")


def read_trace(path):
    """Thread names and their events (name, begin, end, depth) in milliseconds, by thread number."""
    with open(path, encoding="utf-8") as file:
        raw = json.load(file)["traceEvents"]
    names = {e["tid"]: e["args"]["name"] for e in raw if e["ph"] == "M"}
    threads = {}
    for e in raw:
        if e["ph"] == "X":
            begin = e["ts"] / 1000
            threads.setdefault(e["tid"], []).append([e["name"], begin, begin + e["dur"] / 1000])
    for tid, events in threads.items():
        events.sort(key=lambda e: (e[1], -e[2]))
        open_ends = []
        for event in events:
            while open_ends and open_ends[-1] <= event[1]:
                open_ends.pop()
            event.append(len(open_ends))
            open_ends.append(event[2])
    order = sorted(threads, key=lambda tid: (names[tid] != "main", names[tid]))
    return [(names[tid], threads[tid]) for tid in order]


def color_of(name, others):
    if name in COLORS:
        return COLORS[name]
    if name not in others:
        others[name] = OTHER_COLORS[len(others) % len(OTHER_COLORS)]
    return others[name]


def nice_step(span):
    """A round distance [ms] of about eight marks on the axis."""
    step = 10.0 ** -4
    while True:
        for factor in (1, 2, 5):
            if span / (step * factor) <= 10:
                return step * factor
        step *= 10


def draw(threads, begin, end, title):
    """The picture as a list of SVG lines."""
    scale = (WIDTH - LEFT - RIGHT) / (end - begin)
    x = lambda t: LEFT + (min(max(t, begin), end) - begin) * scale
    others, shown = {}, []
    # A frame is the whole row: the levels below it move up.
    lanes = []
    for name, events in threads:
        in_frames = any(e[0] == "frame" for e in events)
        visible = [(what, t0, t1, depth - in_frames) for what, t0, t1, depth in events
                   if what != "frame" and t1 > begin and t0 < end]
        lanes.append((name, visible, 1 + max((e[3] for e in visible), default=0)))
    bottom = TOP + sum(levels * BAR + GAP for _, _, levels in lanes)
    body = []
    step = nice_step(end - begin)
    for i in range(int((end - begin) / step + 1e-9) + 1):
        at = x(begin + i * step)
        body.append(f'<line x1="{at:.1f}" y1="{TOP - 6}" x2="{at:.1f}" y2="{bottom}" stroke="#e4e4e4"/>')
        body.append(f'<text x="{at:.1f}" y="{bottom + 14}" text-anchor="middle">{i * step:g} ms</text>')
    y = TOP
    for name, events, levels in lanes:
        body.append(f'<text x="{LEFT - 10}" y="{y + BAR - 4}" text-anchor="end">{escape(name)}</text>')
        body.append(f'<rect x="{LEFT}" y="{y}" width="{WIDTH - LEFT - RIGHT}" height="{levels * BAR}" fill="#fafafa"/>')
        for what, t0, t1, level in events:
            if what not in shown:
                shown.append(what)
            width = max(x(t1) - x(t0), 0.5)
            rim = ' stroke="#ffffff" stroke-width="0.4"' if width > THIN else ""
            body.append(f'<rect x="{x(t0):.1f}" y="{y + level * BAR}" width="{width:.1f}" height="{BAR - 1}" '
                        f'fill="{color_of(what, others)}"{rim}/>')
        y += levels * BAR + GAP
    shown.sort(key=lambda name: (IN_LEGEND_LAST.index(name) + 1 if name in IN_LEGEND_LAST else 0))
    at, y = LEFT, bottom + 30
    for name in shown:
        wide = 26 + 6.6 * len(name)
        if at + wide > WIDTH - RIGHT:
            at, y = LEFT, y + 18
        body.append(f'<rect x="{at}" y="{y}" width="12" height="12" fill="{color_of(name, others)}" stroke="#999"/>')
        body.append(f'<text x="{at + 17}" y="{y + 10}">{escape(name)}</text>')
        at += wide
    height = y + 24
    return [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" '
        f'viewBox="0 0 {WIDTH} {height}" {FONT} font-size="11" fill="#333">',
        f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>',
        f'<text x="{LEFT}" y="20" font-size="14" fill="#111">{escape(title)}</text>',
        *body,
        "</svg>",
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trace")
    parser.add_argument("picture")
    parser.add_argument("--title", default="")
    parser.add_argument("--from-ms", type=float, help="start of the picture (default: of the trace)")
    parser.add_argument("--to-ms", type=float, help="its end")
    arguments = parser.parse_args()
    threads = read_trace(arguments.trace)
    if not threads:
        sys.exit(f"draw_trace.py: {arguments.trace}: no events, expected a trace of a run")
    times = [t for _, events in threads for e in events for t in e[1:3]]
    begin = arguments.from_ms if arguments.from_ms is not None else min(times)
    end = arguments.to_ms if arguments.to_ms is not None else max(times)
    if not begin < end:
        sys.exit(f"draw_trace.py: --from-ms {begin} --to-ms {end}: expected a stretch of time")
    with open(arguments.picture, "w", encoding="utf-8") as file:
        file.write("\n".join(draw(threads, begin, end, arguments.title)) + "\n")


if __name__ == "__main__":
    main()
