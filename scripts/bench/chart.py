"""A log-log chart as SVG. Series differ in marker and dashes, so that it can be read without colour."""

import dataclasses
import itertools
import math

WIDTH, HEIGHT = 760, 520
FONT = 'font-family="sans-serif" font-size="12"'
LEFT, RIGHT, TOP, BOTTOM = 70, 150, 40, 60
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#333333", "#e69f00")
DASHES = ("", "8 4", "2 3", "8 3 2 3", "14 4", "5 5")
MARKERS = (
    "M-4,0 a4,4 0 1,0 8,0 a4,4 0 1,0 -8,0",  # circle
    "M-4,-4 h8 v8 h-8 z",  # square
    "M0,-5 L5,4 L-5,4 z",  # triangle
    "M0,-5 L5,0 L0,5 L-5,0 z",  # diamond
    "M-4,-4 L4,4 M-4,4 L4,-4",  # cross
    "M-5,0 H5 M0,-5 V5",  # plus
)


@dataclasses.dataclass(frozen=True)
class Series:
    """A named line of points."""

    name: str
    points: list[tuple[float, float]]


class Axis:
    """A logarithmic scale from a decade to another."""

    def __init__(self, values: list[float], start: float, end: float) -> None:
        self.low = math.floor(math.log10(min(values)))
        self.high = max(math.ceil(math.log10(max(values))), self.low + 1)
        self.start, self.end = start, end

    def at(self, value: float) -> float:
        """The coordinate of a value."""
        share = (math.log10(value) - self.low) / (self.high - self.low)
        return self.start + share * (self.end - self.start)

    def decades(self) -> list[int]:
        """The exponents to be marked."""
        return list(range(self.low, self.high + 1))


def power(exponent: int) -> str:
    """A power of ten as people write it."""
    if 0 <= exponent <= 3:
        return str(10**exponent)
    if -3 <= exponent < 0:
        return f"{10.0**exponent:g}"
    return f'10<tspan dy="-5" font-size="9">{exponent}</tspan>'


def grid(x: Axis, y: Axis, labels: tuple[str, str]) -> list[str]:
    """The axes with their decades and titles."""
    parts = []
    for exponent in x.decades():
        at = x.at(10.0**exponent)
        parts.append(f'<path d="M{at:.1f},{y.start} V{y.end}" stroke="#ddd"/>')
        parts.append(f'<text x="{at:.1f}" y="{y.start + 18}" text-anchor="middle">{power(exponent)}</text>')
    for exponent in y.decades():
        at = y.at(10.0**exponent)
        parts.append(f'<path d="M{x.start},{at:.1f} H{x.end}" stroke="#ddd"/>')
        parts.append(f'<text x="{x.start - 8}" y="{at + 4:.1f}" text-anchor="end">{power(exponent)}</text>')
    middle = (x.start + x.end) / 2, (y.start + y.end) / 2
    parts.append(f'<text x="{middle[0]}" y="{HEIGHT - 16}" text-anchor="middle">{labels[0]}</text>')
    turn = f'transform="translate(18,{middle[1]}) rotate(-90)"'
    parts.append(f'<text {turn} text-anchor="middle">{labels[1]}</text>')
    parts.append(f'<path d="M{x.start},{y.end} V{y.start} H{x.end}" fill="none" stroke="black"/>')
    return parts


def linear(x: Axis, y: Axis) -> list[str]:
    """A line of slope 1 to compare with, through a corner of the chart, and what it is beside the axes."""
    span = min(x.high - x.low, y.high - y.low)
    ends = [(x.at(10.0 ** (x.high - s)), y.at(10.0 ** (y.low + span - s))) for s in (span, 0)]
    (x1, y1), (x2, y2) = ends
    return [
        f'<path d="M{x1:.1f},{y1:.1f} L{x2:.1f},{y2:.1f}" stroke="#999" stroke-dasharray="1 3"/>',
        f'<path d="M{WIDTH - RIGHT + 14},{y.start - 4} h28" stroke="#999" stroke-dasharray="1 3"/>',
        f'<text x="{WIDTH - RIGHT + 50}" y="{y.start}" fill="#666">linear</text>',
    ]


def apart(wanted: list[float], distance: float) -> list[float]:
    """Heights near the wanted ones that are so far apart."""
    order = sorted(range(len(wanted)), key=lambda i: wanted[i])
    placed = list(wanted)
    for before, after in itertools.pairwise(order):
        placed[after] = max(placed[after], placed[before] + distance)
    return placed


def line(index: int, series: Series, x: Axis, y: Axis, label: float) -> list[str]:
    """A series with its markers, and its name at its end."""
    places = [(x.at(a), y.at(b)) for a, b in series.points]
    colour, kind = COLOURS[index % len(COLOURS)], index % len(MARKERS)
    path = " L".join(f"{a:.1f},{b:.1f}" for a, b in places)
    dashes = f' stroke-dasharray="{DASHES[kind]}"' if DASHES[kind] else ""
    parts = [f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="1.5"{dashes}/>']
    for a, b in places:
        style = f'fill="white" stroke="{colour}" stroke-width="1.5"'
        parts.append(f'<path d="{MARKERS[kind]}" transform="translate({a:.1f},{b:.1f})" {style}/>')
    name = RIGHT - 50
    parts.append(f'<path d="{MARKERS[kind]}" transform="translate({WIDTH - name - 12},{label:.1f})" {style}/>')
    end = places[-1]
    leader = f'd="M{end[0] + 6:.1f},{end[1]:.1f} L{WIDTH - name - 20},{label:.1f}"'
    parts.append(f'<path {leader} stroke="{colour}" stroke-width="0.5" fill="none"/>')
    parts.append(f'<text x="{WIDTH - name}" y="{label + 4:.1f}">{series.name}</text>')
    return parts


def draw(title: str, labels: tuple[str, str], every: list[Series]) -> str:
    """The whole picture. Each series has points, with positive coordinates."""
    points = [point for series in every for point in series.points]
    x = Axis([a for a, _ in points], LEFT, WIDTH - RIGHT)
    y = Axis([b for _, b in points], HEIGHT - BOTTOM, TOP)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" {FONT}>',
        f"<title>{title}</title>",
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
        f'<text x="{LEFT}" y="22" font-size="14">{title}</text>',
        *grid(x, y, labels),
        *linear(x, y),
    ]
    heights = apart([y.at(series.points[-1][1]) for series in every], 16)
    for index, (series, label) in enumerate(zip(every, heights)):
        parts += line(index, series, x, y, label)
    return "\n".join([*parts, "</svg>", ""])


def slope(points: list[tuple[float, float]]) -> float | None:
    """The exponent of the power law that fits best; None for fewer than two points."""
    logs = [(math.log(a), math.log(b)) for a, b in points]
    if len(logs) < 2:
        return None
    mean_x = sum(a for a, _ in logs) / len(logs)
    mean_y = sum(b for _, b in logs) / len(logs)
    spread = sum((a - mean_x) ** 2 for a, _ in logs)
    return sum((a - mean_x) * (b - mean_y) for a, b in logs) / spread if spread else None
