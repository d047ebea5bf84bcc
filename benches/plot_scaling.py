#!/usr/bin/env python3
"""Draws what scaling.sh prints: nanoseconds a point against points, a line for each program and number of threads, as SVG.
Prints the slope of log(time) over log(points) between the first and the last size from 10 000 on to the standard error."""
import math
import sys

WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 760, 440, 70, 20, 190, 50
COLORS = ["#1b6ca8", "#62a8d8", "#b23a48", "#e08e45", "#5b8c5a", "#7a5195"]

lines = {}
for row in map(str.split, sys.stdin):
    if len(row) >= 9:
        lines.setdefault((row[0], int(row[3])), []).append((int(row[2]), float(row[4])))
if not lines:
    sys.exit("no lines in the form of bench_triangulation")

sizes = [n for line in lines.values() for n, _ in line]
costs = [s * 1e9 / n for line in lines.values() for n, s in line]
x0, x1 = math.log10(min(sizes)), math.log10(max(sizes))
y1 = max(costs) * 1.1


def x(n):
    return LEFT + (math.log10(n) - x0) / max(x1 - x0, 1) * (WIDTH - LEFT - RIGHT)


def y(cost):
    return HEIGHT - BOTTOM - cost / y1 * (HEIGHT - TOP - BOTTOM)


def text(at_x, at_y, what, anchor="middle", more=""):
    return f'<text x="{at_x:.1f}" y="{at_y:.1f}" text-anchor="{anchor}"{more}>{what}</text>'


out = [
    f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="13">',
    f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
]
for power in range(math.ceil(x0), math.floor(x1) + 1):
    out.append(f'<path d="M{x(10**power):.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#ddd"/>')
    out.append(text(x(10**power), HEIGHT - BOTTOM + 18, f"10<tspan dy='-5' font-size='9'>{power}</tspan>"))
step = 10 ** math.floor(math.log10(y1))
step = step if y1 / step >= 3 else step / 2
for k in range(int(y1 / step) + 1):
    out.append(f'<path d="M{LEFT} {y(k * step):.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>')
    out.append(text(LEFT - 8, y(k * step) + 4, f"{k * step:g}", "end"))
out.append(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 10, "points"))
out.append(text(18, (TOP + HEIGHT - BOTTOM) / 2, "ns a point", more=f' transform="rotate(-90 18 {(TOP + HEIGHT - BOTTOM) / 2})"'))
labels = []
for color, ((program, threads), line) in zip(COLORS * 9, lines.items()):
    line.sort()
    path = " ".join(f"{x(n):.1f},{y(s * 1e9 / n):.1f}" for n, s in line)
    out.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="2"/>')
    out += [f'<circle cx="{x(n):.1f}" cy="{y(s * 1e9 / n):.1f}" r="3" fill="{color}"/>' for n, s in line]
    labels.append((y(line[-1][1] * 1e9 / line[-1][0]) + 4, f"{program}, {threads} thread{'s' * (threads > 1)}", color, x(line[-1][0])))
    large = [(n, s) for n, s in line if n >= 10_000]
    if len(large) > 1:
        slope = math.log(large[-1][1] / large[0][1]) / math.log(large[-1][0] / large[0][0])
        print(f"{program} {threads}: slope {slope:.3f} from {large[0][0]} to {large[-1][0]}", file=sys.stderr)
below = -math.inf
for at, label, color, end in sorted(labels):
    below = max(at, below + 16)
    out.append(text(WIDTH - RIGHT + 8, below, label, "start", f' fill="{color}"'))
out.append("</svg>")
print("\n".join(out))
