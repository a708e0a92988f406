"""The rows of examples/field/motorway.cpp, measured likewise on SUMO's default drivers."""

import math
import statistics
import xml.etree.ElementTree as xml

from .simulation import CARS, Simulation, cars_and_trucks, element, flow, follower_headways, mean, space_mean_speed

KMH = 1 / 3.6
LIMIT = 112.65 * KMH  # 70 mph
# What SUMO's importer of OpenStreetMap takes for a motorway without a limit (data/typemap/osmNetconvert.typ.xml).
NO_LIMIT = 39.44
WARM_UP, DURATION = 600.0, 900.0  # [s]


def straight_road(simulation, length, lanes, limit, drop=0.0):
    """Edges "a" and, beyond `drop` [m], "b", which has one lane less; lane 0 is the rightmost one."""
    ends = [0.0, drop, length] if drop else [0.0, length]
    nodes = [element("node", id=f"n{i}", x=x, y=0) for i, x in enumerate(ends)]
    edges = [
        element("edge", id="ab"[i], from_=f"n{i}", to=f"n{i + 1}", numLanes=lanes - i, speed=limit, priority=1, width=3.75)
        for i in range(len(ends) - 1)
    ]
    kept = [
        element("connection", from_="a", to="b", fromLane=lane, toLane=lane - 1) for lane in range(1, lanes) if drop
    ]
    simulation.build(nodes, edges, kept)


def demand(lanes, per_hour, types=CARS, edges="a"):
    kind = "people" if "people" in types else "car"
    return [
        types,
        element("route", id="all", edges=edges),
        *(flow(f"lane{i}", "all", per_hour, WARM_UP + DURATION, kind, departLane=i) for i in range(lanes)),
    ]


class Segment:
    """What passes a detector on three lanes in 15 minutes, after 10 minutes in which traffic builds up."""

    def __init__(self, settings, folder, per_hour, seed, limit=LIMIT, types=CARS):
        simulation = Simulation(folder, settings)
        straight_road(simulation, 6000.0, 3, limit)
        for lane in range(3):
            simulation.detect(f"a_{lane}", 4500.0)
        totals = element("edgeData", id="totals", file=simulation.path("totals.xml"), begin=WARM_UP, end=WARM_UP + DURATION)
        changes = simulation.path("changes.xml")
        simulation.run(
            demand(3, per_hour, types), WARM_UP + DURATION, seed, additional=[totals], lanechange_output=changes
        )
        self.passages = simulation.passages(WARM_UP)
        self.flow = len(self.passages) * 3600.0 / DURATION / 3  # [1/h] a lane
        self.speed = space_mean_speed(self.passages)
        self.headways = follower_headways(self.passages)
        edge = xml.parse(simulation.path("totals.xml")).find(".//edge")
        kilometres = float(edge.get("sampledSeconds")) * float(edge.get("speed")) / 1000.0
        begun = [one for one in xml.parse(changes).iter("change") if float(one.get("time")) >= WARM_UP]
        self.changes_per_kilometre = len(begun) / kilometres


def interpolated(curve, x):
    right = next((i for i in range(1, len(curve) - 1) if curve[i][0] >= x), len(curve) - 1)
    (x0, y0), (x1, y1) = curve[right - 1 : right + 1]
    return y0 + (y1 - y0) * (x - x0) / (x1 - x0)


def basic_segment(settings, folder):
    """Three lanes with cars and a limit of 70 mph."""
    every, speeds = [], []
    for per_hour in (100, 900, 1200, 1500, 1800, 2000, 2200, 2400, 2700):
        every.append(Segment(settings, folder, per_hour, settings.seed + per_hour))
        if not speeds or every[-1].flow > speeds[-1][0]:
            speeds.append((every[-1].flow, every[-1].speed))
    most = max(every, key=lambda one: one.flow)
    means = [mean(one.headways) for one in every[1:6]]
    shares = [one.speed / LIMIT for one in every[0].passages]
    return [
        every[0].speed / KMH,
        most.flow,
        interpolated(speeds, 1500.0) / KMH,
        interpolated(speeds, 2000.0) / KMH,
        most.flow / (most.speed / KMH),
        mean(means),
        mean([statistics.pstdev(one.headways) for one in every[1:6]]),
        max(means) - min(means),
        mean([one.changes_per_kilometre for one in every[3:6]]),
        # By default a vehicle jumps to the middle of the other lane within one step.
        0.0,
        0.0,
        mean(shares),
        statistics.pstdev(shares),
    ]


def with_trucks(settings, folder):
    """Capacity with 15 % of lorries, in shares of what the handbook gives."""
    share, equivalent, base = 0.15, 2.0, 2400.0
    most = max(
        Segment(settings, folder, per_hour, settings.seed + 1, types=cars_and_trucks(share)).flow
        for per_hour in (1800, 2100, 2400)
    )
    return [most * (1 + share * (equivalent - 1)) / base]


def without_limit(settings, folder):
    traffic = Segment(settings, folder, 500, settings.seed, NO_LIMIT, cars_and_trucks(0.1))
    speeds = [one.speed / KMH for one in traffic.passages if one.kind == "people_car"]
    return [
        mean(speeds),
        sum(speed > 130.0 for speed in speeds) / len(speeds),
    ]


def lane_drop(settings, folder):
    """Three lanes become two: what passes at a demand far above capacity, against the most that passes at any."""
    drop, passed = 3000.0, []
    for per_hour in (1200, 1300, 1400, 1500, 1600, 2200):
        simulation = Simulation(folder, settings)
        straight_road(simulation, 6000.0, 3, LIMIT, drop)
        for lane in range(2):
            simulation.detect(f"b_{lane}", 1500.0)
        simulation.run(demand(3, per_hour, edges="a b"), WARM_UP + DURATION, settings.seed)
        passed.append(len(simulation.passages(WARM_UP)))
    return [1.0 - passed[-1] / max(passed)]


def queue(settings, folder):
    """A queue on one lane is let go: the wave of those who start."""
    count, first, moves = 150, 10, 20.0 * KMH
    simulation = Simulation(folder, settings)
    straight_road(simulation, 6000.0, 1, LIMIT)
    length, gap = 5.0, 2.5  # of the default car [m]
    places = [4500.0 - gap - i * (length + gap) for i in range(count)]
    cars = [
        element("vehicle", id=i, type="car", route="all", depart=0, departPos=place, departSpeed=0, insertionChecks="none")
        for i, place in enumerate(places)
    ]
    simulation.run([CARS, element("route", id="all", edges="a"), *cars], 400.0, settings.seed, trajectories=True)
    driven = simulation.trajectories()
    started = [next(one.time for one in driven[str(i)] if one.speed > moves) for i in range(count)]
    slope = regression(started[first:], places[first:])
    return [slope / KMH]


def regression(x, y):
    """Slope of y on x."""
    mean_x, mean_y = mean(x), mean(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def noise(settings, folder):
    """A driver follows one who keeps its speed."""
    sampled, warm_up, duration, speed = 0.2, 60.0, 1800.0, 20.0
    leader = element("vType", id="leader", vClass="passenger", sigma=0, speedDev=0, maxSpeed=speed)
    deviations, lags = [], []
    for number in range(8):
        simulation = Simulation(folder, settings)
        straight_road(simulation, 45000.0, 1, NO_LIMIT)
        both = [
            element("vehicle", id=name, type=kind, route="all", depart=0, departPos=place, departSpeed=speed)
            for name, kind, place in (("leader", "leader", 50.0), ("follower", "car", 10.0))
        ]
        simulation.run(
            [CARS, leader, element("route", id="all", edges="a"), *both],
            warm_up + duration,
            settings.seed + number,
            trajectories=True,
        )
        every = max(1, round(sampled / settings.step))
        speeds = [one.speed for one in simulation.trajectories()["follower"] if one.time > warm_up][::every]
        accelerations = [(b - a) / (every * settings.step) for a, b in zip(speeds, speeds[1:])]
        deviations.append(statistics.pstdev(accelerations))
        lags.append(correlation_lag(accelerations) * every * settings.step)
    return [
        mean(deviations),
        mean(lags),
    ]


def correlation_lag(values):
    """The lag at which the autocorrelation has fallen to 1 / e."""
    middle, variance, lag, correlation = mean(values), statistics.pvariance(values), 0, 1.0
    while correlation > math.exp(-1.0) and lag < 200:
        lag += 1
        products = [(a - middle) * (b - middle) for a, b in zip(values, values[lag:])]
        correlation = mean(products) / variance
    return lag


EXPERIMENTS = {
    "segment": (
        basic_segment,
        [
            "free speed of the motorway below",
            "capacity of a lane, cars",
            "speed at 1500 cars an hour",
            "speed at 2000 cars an hour",
            "density at capacity",
            "headway of followers, mean",
            "headway of followers, standard deviation",
            "change of that mean from 900 to 2000 cars an hour",
            "lane changes near critical density",
            "duration of a lane change, mean",
            "lane changes of 2.5 to 8 s",
            "speed in shares of the limit, mean",
            "speed in shares of the limit, standard deviation",
        ],
    ),
    "trucks": (with_trucks, ["capacity with 15 % lorries, in shares of the handbook's"]),
    "no limit": (without_limit, ["speed of cars without a limit, mean", "of these above 130 km/h"]),
    "lane drop": (lane_drop, ["capacity drop at a lane drop"]),
    "queue": (queue, ["wave of those who start in a jam"]),
    "noise": (
        noise,
        [
            "noise of the acceleration in following, with human errors",
            "correlation time of that noise",
        ],
    ),
}
