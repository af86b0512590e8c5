#!/usr/bin/env python3
"""Draws bench/results/*.csv as docs/img/bench_*.svg: work against precision, and cost against size."""
import csv
import math
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COLORS = {"bullet": "#b3402e", "bullet_reordered": "#d98c3f", "weft": "#1f5f99", "weft_euler": "#6aa5d6",
          "bullet_forces": "#5b7f3b", "bullet_substeps": "#8c5fa8"}
NAMES = {"bullet": "Bullet's links", "bullet_reordered": "the same, reordered", "weft": "bullet_weft",
         "weft_euler": "bullet_weft, Euler", "bullet_forces": "bullet_forces, explicit",
         "bullet_substeps": "Bullet's links, 4 steps"}
WIDTH, HEIGHT = 330, 250
COLUMNS = 3
LEFT, RIGHT, TOP, BOTTOM = 58, 16, 30, 42


def read(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


class Panel:
    """One log-log diagram at an offset."""

    def __init__(self, x, title, xs, ys, x_label, y_label):
        self.x, self.parts = x, []
        self.x_range = self._decades(xs)
        self.y_range = self._decades(ys)
        self._frame(title, x_label, y_label)

    @staticmethod
    def _decades(values):
        low, high = math.log10(min(values)), math.log10(max(values))
        return low - 0.12 * (high - low + 0.5), high + 0.12 * (high - low + 0.5)

    def place(self, x, y):
        u = (math.log10(x) - self.x_range[0]) / (self.x_range[1] - self.x_range[0])
        v = (math.log10(y) - self.y_range[0]) / (self.y_range[1] - self.y_range[0])
        return self.x + LEFT + u * (WIDTH - LEFT - RIGHT), HEIGHT - BOTTOM - v * (HEIGHT - TOP - BOTTOM)

    def text(self, x, y, text, anchor="middle", extra=""):
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {extra}>{text}</text>')

    def line(self, x1, y1, x2, y2, color):
        self.parts.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{color}"/>')

    def _ticks(self, span):
        steps = (1, 2, 5) if span[1] - span[0] < 2.2 else (1,)
        for decade in range(math.floor(span[0]), math.ceil(span[1]) + 1):
            for step in steps:
                if span[0] <= math.log10(step) + decade <= span[1]:
                    yield step * 10.0**decade

    def _frame(self, title, x_label, y_label):
        right, bottom = self.x + WIDTH - RIGHT, HEIGHT - BOTTOM
        self.text(self.x + (LEFT + WIDTH - RIGHT) / 2, 18, title, extra='font-weight="bold"')
        for tick in self._ticks(self.x_range):
            x = self.place(tick, 10 ** self.y_range[0])[0]
            self.line(x, TOP, x, bottom, "#e4e4e4")
            self.text(x, bottom + 14, f"{tick:g}")
        for tick in self._ticks(self.y_range):
            y = self.place(10 ** self.x_range[0], tick)[1]
            self.line(self.x + LEFT, y, right, y, "#e4e4e4")
            self.text(self.x + LEFT - 5, y + 4, f"{tick:g}", "end")
        self.parts.append(f'<rect x="{self.x + LEFT}" y="{TOP}" width="{WIDTH - LEFT - RIGHT}" '
                          f'height="{HEIGHT - TOP - BOTTOM}" fill="none" stroke="#888"/>')
        self.text(self.x + (LEFT + WIDTH - RIGHT) / 2, HEIGHT - 10, x_label)
        self.text(self.x + 14, (TOP + HEIGHT - BOTTOM) / 2, y_label,
                  extra=f'transform="rotate(-90 {self.x + 14} {(TOP + HEIGHT - BOTTOM) / 2})"')

    def series(self, points, color, joins_all=False):
        """All points; a line through all, or through those that nothing beats at their cost."""
        places = [self.place(*point) for point in points]
        front = [point for point in points if joins_all or all(other[1] >= point[1] for other in points if other[0] <= point[0])]
        path = " ".join("{:.1f},{:.1f}".format(*self.place(*point)) for point in sorted(front))
        if len(front) > 1:
            self.parts.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="1.6"/>')
        self.parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.2" fill="{color}"/>' for x, y in places]


def write(name, panels, legend):
    """Panels in rows of COLUMNS, each made with the offset of its column."""
    rows = math.ceil(len(panels) / COLUMNS)
    width = WIDTH * min(len(panels), COLUMNS)
    height = HEIGHT * rows + 24
    parts = []
    for number, panel in enumerate(panels):
        shift = HEIGHT * (number // COLUMNS)
        parts += [f'<g transform="translate(0 {shift})">', *panel.parts, "</g>"]
    x = LEFT
    for text, color in legend:
        parts.append(f'<circle cx="{x}" cy="{height - 14}" r="4" fill="{color}"/>'
                     f'<text x="{x + 9}" y="{height - 10}">{text}</text>')
        x += 40 + 6.4 * len(text)
    path = ROOT / "docs" / "img" / name
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
                    f'height="{height}" font-family="sans-serif" font-size="11">\n'
                    f'<rect width="{width}" height="{height}" fill="#fff"/>\n' + "\n".join(parts) + "\n</svg>\n",
                    encoding="utf-8")
    print(path.relative_to(ROOT))


def work_precision(results):
    rows = [row for row in read(results / "fast_float32.csv") if "-" not in (row["rms_error_m"], row["median_ms"])]
    panels, known = [], {}
    for workload in dict.fromkeys(row["workload"] for row in rows):
        here = [row for row in rows if row["workload"] == workload]
        times = [float(row["median_ms"]) for row in here]
        errors = [100 * float(row["rms_error_m"]) for row in here]
        panel = Panel(WIDTH * (len(panels) % COLUMNS), workload, times, errors, "ms per step", "RMS error [cm]")
        for solver in dict.fromkeys(row["solver"] for row in here):
            points = [(float(row["median_ms"]), 100 * float(row["rms_error_m"])) for row in here
                      if row["solver"] == solver]
            panel.series(sorted(points), COLORS[solver])
            known[NAMES[solver]] = COLORS[solver]
        panels.append(panel)
    write("bench_work_precision.svg", panels, list(known.items()))


def scaling(results):
    rows = read(results / "scaling.csv")
    nodes = [float(row["nodes"]) for row in rows]
    least = [1e-3 * float(row["least_ns_per_node"]) for row in rows]
    memory = [1e-3 * (float(row["bullet_bytes_per_node"]) + float(row["solver_bytes_per_node"])) for row in rows]
    first = Panel(0, "one step", nodes, least + [2 * max(least), min(least) / 2], "nodes", "us per node")
    second = Panel(WIDTH, "memory, Bullet's and the solver's", nodes, memory + [2 * max(memory), min(memory) / 2],
                   "nodes", "kB per node")
    first.series(list(zip(nodes, least)), COLORS["weft"], joins_all=True)
    second.series(list(zip(nodes, memory)), COLORS["weft"], joins_all=True)
    write("bench_scaling.svg", [first, second], [(NAMES["weft"], COLORS["weft"])])


def main():
    results = ROOT / "bench" / "results"
    (ROOT / "docs" / "img").mkdir(exist_ok=True)
    work_precision(results)
    scaling(results)
    return 0


if __name__ == "__main__":
    sys.exit(main())
