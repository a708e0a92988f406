"""Junctions with one lane each way, as in examples/field/junction.cpp, and what observers beside the road note."""

import bisect
import collections
import math
import statistics
import xml.etree.ElementTree as xml

from .simulation import CARS, Simulation, element, flow

TOWN_LIMIT = 50 / 3.6  # [m/s]
WHEELS = 0.9  # of a car behind its front end [m]: what observers see passing a line
SATURATED = 3600.0  # demand [1/h] of a queue that does not end


def crossing(kind, limit=TOWN_LIMIT):
    """Builds two streets that cross: "1i" leads in from arm 1 (east), "1o" out to it; 2, 3, 4: north, west, south. `kind`
    is that of SUMO's node; arms 1 and 3 have priority where it has signs."""
    nodes, edges = [element("node", id="c", x=0, y=0, type=kind, radius=6.5)], []  # arms end 10 m from the middle
    for i in range(4):
        length = 10.0 + (100.0 if i % 2 else 200.0)
        along = (round(math.cos(0.5 * math.pi * i)), round(math.sin(0.5 * math.pi * i)))
        nodes.append(element("node", id=i + 1, x=length * along[0], y=length * along[1]))
        for name, ends in ((f"{i + 1}i", (i + 1, "c")), (f"{i + 1}o", ("c", i + 1))):
            rank = 1 if i % 2 else 2
            edges.append(element("edge", id=name, from_=ends[0], to=ends[1], speed=limit, width=3.5, priority=rank))
    return lambda simulation: simulation.build(nodes, edges)


def roundabout(simulation):
    """One lane, 20 m radius, four arms "1i", "1o", ...; "r1" leads on from arm 1, counter-clockwise."""
    radius, length, nodes, edges = 20.0, 122.0, [], []
    for i in range(4):
        at = [(r * math.cos(0.5 * math.pi * i), r * math.sin(0.5 * math.pi * i)) for r in (radius, length)]
        nodes += [element("node", id=f"{kind}{i + 1}", x=x, y=y) for kind, (x, y) in zip("cn", at)]
        arc = [0.5 * math.pi * (i + step / 9) for step in range(10)]
        shape = " ".join(f"{radius * math.cos(a):.3f},{radius * math.sin(a):.3f}" for a in arc)
        center, outside, next_ = f"c{i + 1}", f"n{i + 1}", f"c{(i + 1) % 4 + 1}"
        edges += [
            element("edge", id=f"{i + 1}i", from_=outside, to=center, speed=TOWN_LIMIT),
            element("edge", id=f"{i + 1}o", from_=center, to=outside, speed=TOWN_LIMIT),
            element("edge", id=f"r{i + 1}", from_=center, to=next_, speed=30 / 3.6, shape=shape),
        ]
    ring = element("roundabout", nodes="c1 c2 c3 c4", edges="r1 r2 r3 r4")
    simulation.build(nodes, edges, more=[ring])


class Net:
    """The lanes of a network, and how they lead through junctions."""

    def __init__(self, file):
        root = xml.parse(file).getroot()
        self.lengths, self.shapes = {}, {}
        for lane in root.iter("lane"):
            self.lengths[lane.get("id")] = float(lane.get("length"))
            self.shapes[lane.get("id")] = [tuple(map(float, p.split(",")[:2])) for p in lane.get("shape").split()]
        self.connections = list(root.iter("connection"))
        self.via = {(one.get("from"), one.get("to")): one.get("via") for one in self.connections}

    def through(self, begin, end):
        """The lanes within the junction between two edges."""
        lanes, at = [], begin
        while self.via.get((at, end)):
            lanes.append(self.via[at, end])
            at = lanes[-1].rsplit("_", 1)[0]
        return lanes

    def segments(self, lanes):
        """(lane, where on it the segment begins and ends [m], the segment's two points)."""
        for lane in lanes:
            shape = self.shapes[lane]
            sizes = [math.dist(a, b) for a, b in zip(shape, shape[1:])]
            scale, s = self.lengths[lane] / max(1e-9, sum(sizes)), 0.0
            for a, b, size in zip(shape, shape[1:], sizes):
                yield lane, s, s + size * scale, a, b
                s += size * scale

    def ways(self, edges):
        """The lanes within each junction that a route leads through, and the edge behind it."""
        return [(self.through(*both), both[1]) for both in zip(edges, edges[1:])]

    def meeting(self, own, other):
        """Where two routes first meet in a junction: (lane, place) of each; None where they do not."""
        for mine, to in self.ways(own):
            for theirs, also_to in self.ways(other):
                for a in self.segments(mine):
                    for b in self.segments(theirs):
                        at = crossing_of(*a[3:], *b[3:])
                        if at:
                            places = [one[1] + (one[2] - one[1]) * share for one, share in zip((a, b), at)]
                            return [self.within(one[0], place) for one, place in zip((a, b), places)]
                if to == also_to:
                    return [self.within(lanes[-1], math.inf) for lanes in (mine, theirs)]
        return None

    def within(self, lane, place):
        """A place at which SUMO accepts a detector."""
        return lane, min(place, self.lengths[lane] - 0.05)


def crossing_of(a, b, c, d):
    """The shares at which two segments cross, or None."""
    ux, uy, vx, vy = b[0] - a[0], b[1] - a[1], d[0] - c[0], d[1] - c[1]
    size = ux * vy - uy * vx
    if abs(size) < 1e-9:
        return None
    wx, wy = c[0] - a[0], c[1] - a[1]
    s, t = (wx * vy - wy * vx) / size, (wx * uy - wy * ux) / size
    return (s, t) if 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0 else None


def lights(net, phases):
    """A plan of the lights of `crossing`: of each phase its duration [s] and the colours (G, y, r) of the streets from arm 1
    and from arm 2. Who turns left gives way to those who come from ahead."""
    links = [one for one in net.connections if one.get("tl")]
    links.sort(key=lambda one: int(one.get("linkIndex")))
    said = []
    for duration, *colours in phases:
        state = [colours[1 - int(one.get("from")[0]) % 2] for one in links]
        state = ["g" if colour == "G" and one.get("dir") == "l" else colour for colour, one in zip(state, links)]
        said.append(element("phase", duration=duration, state="".join(state)))
    return [f'<tlLogic id="c" type="static" programID="plan" offset="0">{"".join(said)}</tlLogic>']


Stream = collections.namedtuple("Stream", "edges per_hour")  # None per hour: a queue that does not end
Rivalry = collections.namedtuple("Rivalry", "stream own others")  # when each passed the place where their ways meet
Decision = collections.namedtuple("Decision", "rejected accepted")  # gaps [s]


class Junction:
    """Streams through a junction that `build(simulation)` makes, and when their vehicles pass. Those of streams 1, 2, ...
    that cross or join stream 0 are its rivals. The line is where SUMO's vehicles wait: for some who turn left, within the
    junction."""

    def __init__(self, settings, folder, build, streams, duration, seed, types=CARS, plan=()):
        self.simulation = simulation = Simulation(folder, settings)
        build(simulation)
        net = Net(simulation.path("net.xml"))
        self.places = {}  # of detectors: what they note -> name
        for i, one in enumerate(streams):
            *before, lane = [f"{one.edges[0]}_0", *net.through(*one.edges[:2])]
            self.detect(("line", i), lane, min(WHEELS, 0.5 * net.lengths[lane]))
            self.detect(("first", i), before[-1], max(0.0, net.lengths[before[-1]] - 3.0))
        self.rivals = []
        for i in range(1, len(streams)):
            met = net.meeting(streams[0].edges, streams[i].edges)
            if met:
                self.rivals.append(i)
                self.detect(("own", i), *met[0])
                self.detect(("other", i), *met[1])
        kind = "people" if "people" in types else "car"
        traffic = [types]
        for i, one in enumerate(streams):
            traffic.append(element("route", id=f"r{i}", edges=" ".join(one.edges)))
        for i, one in enumerate(streams):
            traffic.append(flow(f"s{i}", f"r{i}", one.per_hour or SATURATED, duration, kind))
        simulation.run(traffic, duration, seed, additional=lights(net, plan) if plan else ())
        self.noted = collections.defaultdict(dict)
        for one in simulation.passages():
            self.noted[one.lane].setdefault(one.vehicle, one.time)

    def detect(self, what, lane, place):
        self.places[what] = f"{lane}@{place}"
        if not any(f'id="{lane}@{place}"' in one for one in self.simulation.detectors):
            self.simulation.detect(lane, place)

    def times(self, what, stream):
        """When vehicles of a stream passed [s], in order of the time."""
        noted = self.noted[self.places[what]]
        return [time for vehicle, time in noted.items() if vehicle.startswith(f"s{stream}.")]

    def at_line(self, stream):
        return self.times(("line", stream), stream)

    def rivalries(self):
        return [Rivalry(i, self.times(("own", i), 0), self.times(("other", i), i)) for i in self.rivals]

    def became_first(self):
        """When vehicles of stream 0 became the first at the line, within 3 m of it [s]."""
        near, line = self.times(("first", 0), 0), self.at_line(0)
        return [max(time, line[i - 1]) if 0 < i <= len(line) else time for i, time in enumerate(near)]


def gap_of(rivalries, number):
    """The gap into which vehicle `number` of stream 0 went: when the last rival before it and the first behind it passed."""
    begin, end = -math.inf, math.inf
    for one in rivalries:
        behind = bisect.bisect_right(one.others, one.own[number])
        if behind > 0:
            begin = max(begin, one.others[behind - 1])
        if behind < len(one.others):
            end = min(end, one.others[behind])
    return begin, end


def crossed(rivalries):
    return min((len(one.own) for one in rivalries), default=0)


def decisions(junction):
    """Of those in stream 0 that were first at the line when the gap that they took began."""
    rivalries, first, found = junction.rivalries(), junction.became_first(), []
    passages = sorted(time for one in rivalries for time in one.others)
    for i in range(crossed(rivalries)):
        begin, end = gap_of(rivalries, i)
        if begin < first[i] or math.isinf(end):
            continue
        since = bisect.bisect_left(passages, first[i])
        refused = [b - a for a, b in zip(passages[since:], passages[since + 1 :]) if b <= begin]
        found.append(Decision(max(refused, default=0.0), end - begin))
    return found


def follow_ups(junction):
    """Headways [s] at the line of those in stream 0 that follow each other in the same gap."""
    rivalries, line = junction.rivalries(), junction.at_line(0)
    gaps = [gap_of(rivalries, i) for i in range(crossed(rivalries))]
    return [line[i] - line[i - 1] for i in range(1, len(gaps)) if gaps[i] == gaps[i - 1]]


def critical_gap(every):
    """Mean of the drivers' critical gaps [s], lognormal, by maximum likelihood (Troutbeck 1992)."""

    def likelihood(mu, sigma):
        of = statistics.NormalDist(mu, sigma)
        total = 0.0
        for rejected, accepted in every:
            most = min(rejected, 0.99 * accepted)  # some let a longer gap pass than they take
            share = of.cdf(math.log(accepted)) - (of.cdf(math.log(most)) if most > 0.0 else 0.0)
            total += math.log(max(1e-12, share))
        return total

    at, step = (math.log(5.0), 0.3), 0.2
    best = likelihood(*at)
    while step > 1e-4:
        near = [(at[0] + a, at[1] + b) for a, b in ((step, 0), (-step, 0), (0, step), (0, -step)) if at[1] + b >= 0.02]
        value, place = max((likelihood(*one), one) for one in near)
        if value > best:
            best, at = value, place
        else:
            step *= 0.5
    return math.exp(at[0] + 0.5 * at[1] ** 2)


def gap_capacity(per_hour, critical, follow_up):
    """[1/h] of a stream that gives way to `per_hour`: HCM 7th ed., eq. 20-18 (Harders 1968)."""
    if per_hour == 0.0:
        return 3600.0 / follow_up
    return per_hour * math.exp(-per_hour * critical / 3600.0) / (1.0 - math.exp(-per_hour * follow_up / 3600.0))
