"""The rows of examples/field/town.cpp and gap_acceptance.cpp, measured likewise on SUMO's default drivers."""

import bisect
import collections
import math
import random

from .junction import (
    TOWN_LIMIT,
    Junction,
    Net,
    Stream,
    critical_gap,
    crossing,
    decisions,
    follow_ups,
    gap_capacity,
    lights,
    roundabout,
)
from .motorway import straight_road
from .simulation import CARS, Simulation, cars_and_trucks, element, flow, follower_headways, mean, quantile

WARM_UP, DURATION = 120.0, 1800.0  # [s]
ALL_WAY_RUNS, ALL_WAY_DURATION = 6, 900.0
YELLOW = 3.0  # [s]


def following(settings, folder):
    """Headways of followers on a street."""
    warm_up, duration, headways = 300.0, 5400.0, []
    for number, per_hour in enumerate((500, 800, 1100), 1):
        simulation = Simulation(folder, settings)
        straight_road(simulation, 2000.0, 1, TOWN_LIMIT)
        simulation.detect("a_0", 1500.0)
        traffic = [CARS, element("route", id="all", edges="a"), flow("cars", "all", per_hour, warm_up + duration)]
        simulation.run(traffic, warm_up + duration, settings.seed + number)
        headways += follower_headways(simulation.passages(warm_up), 4.0)
    return [mean(headways), sum(headway < 1.0 for headway in headways) / len(headways)]


def approach(settings, folder, green, cycle, per_hour, duration):
    """When those who go straight on from arm 1 pass the line of a light that is green at first."""
    plan = [(green, "G", "r"), (YELLOW, "y", "r"), (cycle - green - YELLOW, "r", "G")]
    streams = [Stream(("1i", "3o"), per_hour)]
    return Junction(settings, folder, crossing("traffic_light"), streams, duration, settings.seed, plan=plan).at_line(0)


def saturation(settings, folder):
    """Queues at a light: headways from the fifth vehicle on, and what the first four lose."""
    green, cycle, cycles, first = 40.0, 80.0, 40, 4
    times, headways, starts = approach(settings, folder, green, cycle, None, cycle * cycles), [], []
    for begin in (cycle * i for i in range(1, cycles)):
        passed = times[bisect.bisect_left(times, begin) : bisect.bisect_left(times, begin + green)]
        if len(passed) > first:
            starts.append(passed[first - 1] - begin)
            headways += [b - a for a, b in zip(passed[first - 1 :], passed[first:])]
    return [3600.0 / mean(headways), mean(starts) - first * mean(headways)]


def red_running(settings, folder):
    green, cycle, hours = 42.0, 90.0, 50.0
    times = approach(settings, folder, green, cycle, 700.0, 3600.0 * hours)
    runners = sum(time % cycle > green + YELLOW for time in times)
    return [runners / hours, runners / (3600.0 * hours / cycle)]


Alone = collections.namedtuple("Alone", "factor to_line moments")  # to_line: of each moment [m]


def drive_alone(settings, folder, kind, routes, count, distance, plan=None, limit=TOWN_LIMIT):
    """Cars that come one after the other, each alone, from `distance` [m] before the junction; by turns on the `routes`.
    `plan(number, factor)` gives when the light turns yellow after the car has entered [s]."""
    apart, red_until = 90.0, 55.0  # [s]
    draw, simulation, phases, cars = random.Random(settings.seed), Simulation(folder, settings), [], []
    crossing(kind, limit)(simulation)
    net = Net(simulation.path("net.xml"))
    routes = [tuple(route) for route in routes]
    factors = [min(2.0, max(0.2, draw.gauss(1.0, 0.1))) for _ in range(count)]  # those of SUMO's default car
    length = net.lengths[f"{routes[0][0]}_0"]
    green = 0.0
    for i, factor in enumerate(factors):
        if plan:
            turns = max(0.1, plan(i, factor))
            phases += [(round(green + turns, 1), "G", "r"), (YELLOW, "y", "r")]
            phases.append((round(red_until - YELLOW - round(turns, 1), 1), "r", "r"))
            green = apart - red_until
        cars.append(
            element(
                "vehicle", id=i, type="car", route=f"r{i % len(routes)}", depart=apart * i, departPos=length - distance,
                departSpeed=limit * factor, speedFactor=factor,
            )  # fmt: skip
        )
    ways = [element("route", id=f"r{i}", edges=" ".join(route)) for i, route in enumerate(routes)]
    simulation.run(
        [CARS, *ways, *cars], apart * count, settings.seed, True, additional=lights(net, phases) if plan else ()
    )
    found = []
    driven = simulation.trajectories()
    for i, factor in enumerate(factors):
        moments = driven[str(i)]
        stands = next((k for k, one in enumerate(moments) if one.speed < 0.05), len(moments) - 1)
        moments = [one._replace(time=one.time - apart * i) for one in moments[: stands + 1]]
        before = f"{routes[i % len(routes)][0]}_0"
        found.append(Alone(factor, [length - one.place if one.lane == before else -1.0 for one in moments], moments))
    return found


def logistic(x, stopped):
    """Returns where a share p stops, by logistic regression."""
    a = b = 0.0
    for _ in range(50):  # Newton; the small curvature keeps the slope finite where all agree
        ga, gb, aa, ab, bb = 0.0, -1e-3 * b, 1e-6, 0.0, 1e-3
        for value, stops in zip(x, stopped):
            p = 1.0 / (1.0 + math.exp(-(a + b * value)))
            w, error = p * (1.0 - p), stops - p
            ga, gb = ga + error, gb + error * value
            aa, ab, bb = aa + w, ab + w * value, bb + w * value * value
        det = aa * bb - ab * ab
        scale = min(1.0, 2.0 * det / (abs(aa * gb - ab * ga) + 1e-12))
        a, b = a + scale * (bb * ga - ab * gb) / det, b + scale * (aa * gb - ab * ga) / det
    return lambda p: (math.log(p / (1.0 - p)) - a) / b


def yellow(settings, folder):
    """Drivers alone at 70 km/h on their way to a light that turns yellow when they are up to 6.5 s before it."""
    distance, count, brakes, window, limit = 180.0, 500, -0.5, 0.5, 70 / 3.6
    draw = random.Random(settings.seed + 1)
    ways = [draw.uniform(0.5, 6.5) for _ in range(count)]
    turns = [0.0] * count

    def plan(i, factor):
        turns[i] = round(max(0.1, distance / (limit * factor) - ways[i]), 1)
        return turns[i]

    reactions, decelerations, stopped = [], [], []
    cars = drive_alone(settings, folder, "traffic_light", [("1i", "3o")], count, distance, plan, limit)
    for way, turn, (_, to_line, moments) in zip(ways, turns, cars):
        stopped.append(to_line[-1] > 0.0)
        if not stopped[-1] or not 2.5 <= way <= 5.5:
            continue
        # SUMO's drivers dawdle by up to 1.3 m/s^2 from step to step: brakes by more than 0.5 m/s^2 over half a second.
        ahead = max(1, round(window / settings.step))
        onset = next(
            (
                k
                for k in range(len(moments) - ahead)
                if moments[k].time >= turn
                and moments[k + ahead].speed - moments[k].speed < brakes * ahead * settings.step
            ),
            None,
        )
        if onset is not None:
            reactions.append(moments[onset].time - turn)
            decelerations.append(moments[onset].speed ** 2 / (2.0 * (to_line[onset] - to_line[-1])))
    stops = logistic(ways, stopped)
    return [
        quantile(reactions, 0.5),
        quantile(decelerations, 0.5),
        quantile(decelerations, 0.85),
        stops(0.1),
        stops(0.9),
    ]


def stop_braking(settings, folder):
    cars = drive_alone(settings, folder, "allway_stop", [("1i", "3o")], 200, 180.0)
    peaks = [max((a.speed - b.speed) / settings.step for a, b in zip(one.moments, one.moments[1:])) for one in cars]
    return [quantile(peaks, 0.5), quantile(peaks, 0.95)]


def turns(settings, folder):
    """By the mean curvature: SUMO's lanes through junctions are polylines."""
    routes = [("1i", "2o"), ("1i", "4o")]
    cars, net = drive_alone(settings, folder, "priority_stop", routes, 200, 180.0), Net(f"{folder}/net.xml")
    highest = []
    for i, one in enumerate(cars):
        lanes = net.through(*routes[i % 2])
        curvature = 0.5 * math.pi / sum(net.lengths[lane] for lane in lanes)
        highest.append(max(moment.speed**2 * curvature for moment in one.moments if moment.lane in lanes))
    return [quantile(highest, 0.85)]


def errors(settings, folder):
    """Three junctions with all their turns: who collides, and who brakes by half of g."""
    sampled, duration, demand, hard, once = 0.2, 5400.0, 250.0, 4.9, 10.0  # [s, s, 1/h, m/s^2, s]
    kilometres, crashed, near = 0.0, 0, 0
    plan = [(25.0, "r", "G"), (YELLOW, "r", "y"), (2.0, "r", "r"), (25.0, "G", "r"), (YELLOW, "y", "r"), (2.0, "r", "r")]
    for number, (build, phases) in enumerate(
        ((crossing("traffic_light"), plan), (crossing("priority_stop"), ()), (roundabout, ())), 1
    ):
        simulation = Simulation(folder, settings)
        build(simulation)
    
        traffic, flows = [CARS], []
        for a in range(1, 5):
            for further in range(1, 4):
                b = (a - 1 + further) % 4 + 1
                between = [f"r{(a - 1 + k) % 4 + 1}" for k in range(further)] if build is roundabout else []
                traffic.append(element("route", id=f"{a}{b}", edges=" ".join([f"{a}i", *between, f"{b}o"])))
                flows.append(flow(f"f{a}{b}", f"{a}{b}", demand / 3.0, duration))
        collisions = simulation.path("collisions.xml")
        additional = lights(Net(simulation.path("net.xml")), phases) if phases else ()
        simulation.run(
            traffic + flows, duration, settings.seed + number, True, additional,
            collision_output=collisions, collision__action="remove", collision__check_junctions="true",
            collision__mingap_factor=0,
        )  # fmt: skip
        with open(collisions, encoding="utf-8") as file:
            crashed += 2 * file.read().count("<collision ")
        seen = {}
        for vehicle, now in simulation.samples():
            before, braked = seen.get(vehicle, (now, -once))
            if 0.0 < now.time - before.time < sampled - 1e-6:
                continue
            kilometres += 0.5e-3 * (before.speed + now.speed) * (now.time - before.time)
            if before.speed - now.speed > hard * (now.time - before.time) and now.time - braked > once:
                near, braked = near + 1, now.time
            seen[vehicle] = now, braked
    return [crashed / (kilometres / 1e6), near / (kilometres / 1e6)]


def per_hour(times, duration=DURATION):
    """What passes in an hour, of those after the warm-up."""
    return sum(time >= WARM_UP for time in times) * 3600.0 / duration


Movement = collections.namedtuple("Movement", "edges rivals critical follow_up")  # [s]: HCM 7th ed., exh. 20-17, 20-18
FROM_WEST, FROM_EAST = ("3i", "1o"), ("1i", "3o")
MOVEMENTS = {
    "left from major": Movement(("1i", "4o"), [FROM_WEST], 4.1, 2.2),
    "right from minor": Movement(("4i", "1o"), [FROM_WEST], 6.2, 3.3),
    "through from minor": Movement(("4i", "2o"), [FROM_WEST, FROM_EAST], 6.5, 4.0),
    "left from minor": Movement(("4i", "3o"), [FROM_WEST, FROM_EAST], 7.1, 3.5),
}


def drive_movement(settings, folder, movement, per_hour_, seed, types=CARS):
    streams = [Stream(movement.edges, None)]
    streams += [Stream(rival, per_hour_ / len(movement.rivals)) for rival in movement.rivals]
    return Junction(settings, folder, crossing("priority_stop"), streams, WARM_UP + DURATION, seed, types)


def share_of_formula(junction, critical, follow_up):
    """What enters from a saturated minor stream, in shares of what the formula gives for the flow that it met."""
    met = sum(per_hour(one.others) for one in junction.rivalries())
    return per_hour(junction.at_line(0)) / gap_capacity(met, critical, follow_up)


def two_way_stop(settings, folder):
    rows, gaps, seed = [], [], settings.seed
    for movement in MOVEMENTS.values():
        shares, headways, every = [], [], []
        for demand in (200, 400, 600, 800, 1000):
            seed += 1
            junction = drive_movement(settings, folder, movement, demand, seed)
            shares.append(share_of_formula(junction, movement.critical, movement.follow_up))
            every += decisions(junction)
            headways += follow_ups(junction)
        rows += [mean(shares), max(shares, key=lambda share: abs(math.log(max(0.01, share))))]
        gaps += [critical_gap(every), mean(headways)]
    return rows + gaps


def roundabout_capacity(circulating):
    """Entry capacity of a roundabout with one lane [1/h]: HCM 7th ed., eq. 22-1."""
    return 1380.0 * math.exp(-0.00102 * circulating)


def roundabout_flows(settings, folder, circulating, seed, types=CARS):
    """What enters at arm 1, and what circulates there: comes from arm 4 and leaves at arm 2 [1/h]."""
    streams = [Stream(("1i", "r1", "r2", "3o"), None)]
    if circulating > 0.0:
        streams.append(Stream(("4i", "r4", "r1", "2o"), circulating))
    junction = Junction(settings, folder, roundabout, streams, WARM_UP + DURATION, seed, types)
    return per_hour(junction.at_line(0)), sum(per_hour(one.others) for one in junction.rivalries())


def roundabout_entry(settings, folder):
    found = []
    for number, nominal in enumerate((0.0, 500.0, 1000.0), 1):
        entering, circulating = roundabout_flows(settings, folder, nominal, settings.seed + number)
        # What circulates differs a little from what should.
        found.append(entering / roundabout_capacity(circulating) * roundabout_capacity(nominal))
    return found


def all_way_headway(settings, folder, others, seed, types=CARS):
    """Mean headway [s] of those who leave an all-way stop from arm 4, all straight on, with queues on these other arms."""
    demand = 1800.0  # [1/h] more than passes, and at random: so the arms do not begin in step
    straight = {arm: (f"{arm}i", f"{(arm + 1) % 4 + 1}o") for arm in range(1, 5)}
    streams = [Stream(straight[arm], demand) for arm in (4, *others)]
    junction = Junction(settings, folder, crossing("allway_stop"), streams, WARM_UP + ALL_WAY_DURATION, seed, types)
    return 3600.0 / per_hour(junction.at_line(0), ALL_WAY_DURATION)


def all_way_stop(settings, folder):
    found, seed = [], settings.seed
    # With queues on all arms, vehicles keep to the order in which the first ones happened to come: several runs of each.
    for arms in [()], [(2,)], [(1,), (3,)], [(1, 2), (2, 3), (1, 3)], [(1, 2, 3)]:
        headways = []
        for run in range(ALL_WAY_RUNS):
            seed += 1
            headways.append(all_way_headway(settings, folder, arms[run % len(arms)], seed))
        found.append(mean(headways))
    return found


def junctions_with_trucks(settings, folder):
    """Capacities with 15 % of lorries, in shares of what the handbook gives."""
    share, demand, seed = 0.15, 600.0, settings.seed
    types, stops, headways = cars_and_trucks(share), [], []
    for one in MOVEMENTS.values():
        seed += 1
        junction = drive_movement(settings, folder, one, demand, seed, types)
        stops.append(share_of_formula(junction, one.critical + share, one.follow_up + 0.9 * share))
    for _ in range(ALL_WAY_RUNS):
        seed += 1
        headways.append(all_way_headway(settings, folder, (1, 2, 3), seed, types))
    entering, circulating = roundabout_flows(settings, folder, 500.0, seed + 1, types)
    equivalents = 1.0 + share  # of a vehicle, at two cars for a lorry
    return [
        mean(stops),
        (9.6 + 1.7 * share) / mean(headways),
        entering * equivalents / roundabout_capacity(circulating * equivalents),
    ]


def takes_gap(simulation, net, wait, gap, seed, factor):
    """Whether a driver that stands at the stop sign, to turn right, takes a gap of `gap` [s] that begins after `wait` [s]
    in which a car has come every 1.5 s."""
    headway, last = 1.5, 20.0
    own, other = MOVEMENTS["right from minor"].edges, FROM_WEST
    (own_lane, own_place), (other_lane, other_place) = net.meeting(own, other)
    simulation.detectors = []
    simulation.detect(own_lane, own_place)
    before, length = net.lengths[f"{own[0]}_0"], net.lengths[f"{other[0]}_0"]
    passages = [wait - headway * i for i in range(math.ceil(wait / headway))][::-1]
    passages += [wait + gap + headway * i for i in range(int(last / headway))]
    cars = [
        element("vehicle", id="subject", type="car", route="own", depart=0, departPos=before - 1.0, departSpeed=0,
                speedFactor=factor)
    ]  # fmt: skip
    for i, time in enumerate(passages):
        place = length + other_place - TOWN_LIMIT * time
        if place > length - 1.0:
            continue  # too late to enter before the junction
        depart, place = (0.0, place) if place > 5.0 else (time - (length + other_place - 5.0) / TOWN_LIMIT, 5.0)
        cars.append(
            element("vehicle", id=i, type="steady", route="other", depart=round(depart, 2), departPos=place,
                    departSpeed=TOWN_LIMIT, insertionChecks="none")
        )  # fmt: skip
    steady = element("vType", id="steady", vClass="passenger", sigma=0, speedDev=0, tau=0.5, maxSpeed=TOWN_LIMIT)
    ways = [element("route", id=name, edges=" ".join(edges)) for name, edges in (("own", own), ("other", other))]
    simulation.run([CARS, steady, *ways, *cars], wait + gap + 5.0, seed)
    return any(one.vehicle == "subject" and one.time < wait + gap for one in simulation.passages())


def shortest_gap(simulation, net, wait, seed, factor):
    """The shortest gap [s] that the driver takes after it has waited."""
    low, high = 1.5, 20.0
    while high - low > 0.1:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if takes_gap(simulation, net, wait, middle, seed, factor) else (middle, high)
    return high


def patience(settings, folder):
    simulation, draw, falls = Simulation(folder, settings), random.Random(settings.seed), []
    crossing("priority_stop")(simulation)
    net = Net(simulation.path("net.xml"))
    for number in range(15):
        factor = draw.gauss(1.0, 0.1)
        early, late = (shortest_gap(simulation, net, wait, settings.seed + number, factor) for wait in (3.0, 60.0))
        falls.append(early - late)
    return [mean(falls)]


EXPERIMENTS = {
    "following": (following, ["headway of followers in town, mean", "of these below 1 s"]),
    "saturation": (saturation, ["saturation flow of a lane at green", "start-up loss at green"]),
    "red running": (red_running, ["red running on a busy approach, an hour", "red running on a busy approach, a cycle"]),
    "yellow": (
        yellow,
        [
            "reaction of the first to stop at yellow, median",
            "deceleration of the first to stop at yellow, median",
            "deceleration of the first to stop at yellow, 85 %",
            "time to the line at yellow where 10 % stop",
            "time to the line at yellow where 90 % stop",
        ],
    ),
    "stop braking": (
        stop_braking,
        ["hardest braking before a stop sign, median", "hardest braking before a stop sign, 95 %"],
    ),
    "turns": (turns, ["lateral acceleration in turns of 8 to 12 m, 85 %"]),
    "errors": (errors, ["crashed vehicles of human drivers", "hard braking (0.5 g) of human drivers"]),
    "two-way stop": (
        two_way_stop,
        [
            text.format(name)
            for texts in (
                ("two-way stop, {}: capacity in shares of people's", "two-way stop, {}: the share farthest off"),
                ("critical gap, {}", "follow-up headway, {}"),
            )
            for name in MOVEMENTS
            for text in texts
        ],
    ),
    "roundabout": (roundabout_entry, [f"roundabout entry, {ring} cars an hour in the ring" for ring in (0, 500, 1000)]),
    "all-way stop": (
        all_way_stop,
        [
            f"all-way stop, headway with {others}"
            for others in (
                "nobody else",
                "a queue opposite",
                "a queue on one side",
                "queues on two other arms",
                "queues on all arms",
            )
        ],
    ),
    "junctions with trucks": (
        junctions_with_trucks,
        [
            "two-way stop with 15 % lorries, capacity in shares",
            "all-way stop with 15 % lorries, capacity in shares",
            "roundabout with 15 % lorries, capacity in shares",
        ],
    ),
    "patience": (patience, ["fall of the critical gap in 60 s of waiting"]),
}
