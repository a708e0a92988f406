#!/usr/bin/env python3
"""Asks the libraries that Lanelet2 and CommonRoad come from what they read in the corpus, and compares.

usage: check.py lanelet2|commonroad VENV NETWORK REPLAY_DATASET

VENV is a folder for the libraries, which come from PyPI; NETWORK prints what cambium reads (network.cpp); REPLAY_DATASET is the
example that solves planning problems. The corpus is in CAMBIUM_CORPUS, else in ../shared. Prints what differs and is not explained
below, and exits with 1 where something does; "skipped:" and why, where there is no corpus or no library.
"""

import os
import subprocess
import sys
import tempfile
import warnings
import xml.etree.ElementTree as xml
from pathlib import Path

warnings.filterwarnings("ignore")
differences = 0


def differ(sentence):
    global differences
    differences += 1
    print(sentence)


def rows_of(network, *files):
    """cambium's lanes: name -> (successors, left, right, may change left, right, limit [km/h]); pairs of lanelets that findings name."""
    text = subprocess.run([network, *files], capture_output=True, text=True, check=True).stdout
    rows, named = {}, set()
    for name, *values in (line.split() for line in text.splitlines()):
        if name == "named":
            named.add(tuple(values))
            continue
        successors, left, right, change_left, change_right, limit = values
        following = set() if successors == "-" else set(successors.split(","))
        rows[name] = (following, left, right, change_left == "1", change_right == "1", float(limit))
    return rows, named


def at_zero(file, folder):
    """A copy whose coordinates Lanelet2's projector takes back to local_x and local_y, where all nodes have them; its origin."""
    tree = xml.parse(file)
    nodes = tree.findall("node")
    tags = [{tag.get("k"): tag.get("v") for tag in node.findall("tag")} for node in nodes]
    if all("local_x" in t and "local_y" in t for t in tags):
        for node, t in zip(nodes, tags):
            node.set("lat", repr(float(t["local_y"]) / 110574.0))
            node.set("lon", repr(float(t["local_x"]) / 111320.0))
    places = [(float(node.get("lat")), float(node.get("lon"))) for node in nodes]
    copy = Path(folder) / "map.osm"
    tree.write(copy)
    return copy, sum(p[0] for p in places) / len(places), sum(p[1] for p in places) / len(places)


def compare_lanelet2(network, corpus):
    import lanelet2

    files = [*corpus.glob("lanelet2/*.osm"), *corpus.glob("cases/*.osm"), *corpus.glob("scenarios/interaction/*.osm")]
    rules = lanelet2.traffic_rules.create(lanelet2.traffic_rules.Locations.Germany, lanelet2.traffic_rules.Participants.Vehicle)
    for file in sorted(files):
        with tempfile.TemporaryDirectory() as folder:
            copy, latitude, longitude = at_zero(file, folder)
            projector = lanelet2.projection.UtmProjector(lanelet2.io.Origin(latitude, longitude))
            loaded, errors = lanelet2.io.loadRobust(str(copy), projector)
        graph = lanelet2.routing.RoutingGraph(loaded, rules)
        (ours, _), theirs = rows_of(network, file), {}
        passable = [lanelet for lanelet in loaded.laneletLayer if rules.canPass(lanelet)]
        both = [lanelet for lanelet in passable if not rules.isOneWay(lanelet)]
        name = lambda lanelet: "-" if lanelet is None else ("-" if lanelet.inverted() else "") + str(lanelet.id)
        for lanelet in [*passable, *(lanelet.invert() for lanelet in both)]:
            left, right = graph.left(lanelet), graph.right(lanelet)
            theirs[name(lanelet)] = ({name(other) for other in graph.following(lanelet)}, name(left or graph.adjacentLeft(lanelet)),
                                     name(right or graph.adjacentRight(lanelet)), left is not None, right is not None,
                                     rules.speedLimit(lanelet).speedLimit)
        compare(file, ours, theirs)


def compare(file, ours, theirs, named=()):
    """Rows of a file. A link between two lanelets that a finding names may differ."""
    what = "successors", "left neighbour", "right neighbour", "may change left", "may change right", "limit"
    excused = 0
    for name in sorted(ours.keys() | theirs.keys()):
        found = []
        if name not in ours or name not in theirs:
            if name not in ours and (name, name) in named:  # what was left out has a finding of its own
                excused += 1
                continue
            found.append(f"only {'cambium' if name in ours else 'the counterpart'} has it")
        else:
            for word, a, b in zip(what, ours[name], theirs[name]):
                # A limit of 0 says that Lanelet2 knows none, as for INTERACTION's location "city", which it does not define.
                if a == b or (word == "limit" and (b == 0.0 or abs(a - b) < 0.01)):
                    continue
                others = (a ^ b if isinstance(a, set) else {a, b} - {"-"}) if isinstance(a, (set, str)) else set()
                if others and all((name, other) in named for other in others):
                    excused += 1
                else:
                    found.append(f"{word}: cambium {a}, counterpart {b}")
        for sentence in found:
            differ(f"{file.name}: lanelet {name}: {sentence}")
    print(f"{file.name}: {len(theirs)} lanelets; findings explain {excused} differences")


def is_for_cars(lanelet):
    """Whether cambium's drivers use it: not lanes for buses, trains, cyclists or pedestrians alone."""
    users = {user.value for user in lanelet.user_one_way | lanelet.user_bidirectional}
    return not users or bool(users & {"vehicle", "car", "truck", "motorcycle"})


def compare_commonroad(network, corpus, replay_dataset):
    from commonroad.common.file_reader import CommonRoadFileReader

    read = lambda file: CommonRoadFileReader(str(file)).open(lanelet_assignment=False)
    solutions = 0
    for file in sorted([*corpus.glob("scenarios/commonroad/*.xml"), *corpus.glob("cases/*.xml")]):
        scenario, problems = read(file)
        with tempfile.TemporaryDirectory() as folder:
            written = Path(folder) / "written.xml"
            (ours, named), theirs = rows_of(network, file, written), {}
            for lanelet in filter(is_for_cars, scenario.lanelet_network.lanelets):
                beside = lambda other, same: str(other) if other is not None and same else "-"
                theirs[str(lanelet.lanelet_id)] = ({str(other) for other in lanelet.successor},
                                                   beside(lanelet.adj_left, lanelet.adj_left_same_direction),
                                                   beside(lanelet.adj_right, lanelet.adj_right_same_direction))
            # What a finding names is wrong in the file: a link that leads elsewhere, a neighbour that is none.
            compare(file, {name: row for name, row in ours.items() if name[0] != "-"}, theirs, named)
            compare_written(file, (scenario, problems), read(written))
            is_problem = theirs and problems.planning_problem_dict
            solved = [driver for driver in ("idm", "mobil", "urban") if is_problem and
                      check_solution(replay_dataset, driver, file, scenario, problems, Path(folder) / "solution.xml")]
            solutions += len(solved)
    if solutions == 0:
        differ("no driver solved any planning problem")


def compare_written(file, before, after):
    """Whether what cambium read and wrote is the same to CommonRoad."""
    import numpy

    def same(what, a, b):
        if numpy.shape(a) != numpy.shape(b) or not numpy.allclose(a, b, rtol=0.0, atol=1e-6):
            differ(f"{file.name}: written again: {what} was {a}, is {b}")

    for lanelet in before[0].lanelet_network.lanelets:
        again = after[0].lanelet_network.find_lanelet_by_id(lanelet.lanelet_id)
        if again is None:
            differ(f"{file.name}: written again: lanelet {lanelet.lanelet_id} is gone")
            continue
        same(f"lanelet {lanelet.lanelet_id}: left bound", lanelet.left_vertices, again.left_vertices)
        same(f"lanelet {lanelet.lanelet_id}: right bound", lanelet.right_vertices, again.right_vertices)
        for word in ("successor", "predecessor"):
            same(f"lanelet {lanelet.lanelet_id}: {word}", sorted(getattr(lanelet, word)), sorted(getattr(again, word)))
    for obstacle in [*before[0].static_obstacles, *before[0].dynamic_obstacles]:
        again = after[0].obstacle_by_id(obstacle.obstacle_id)
        if again is None:
            differ(f"{file.name}: written again: obstacle {obstacle.obstacle_id} is gone")
            continue
        for step in range(obstacle.initial_state.time_step, obstacle.initial_state.time_step + 200):
            was, now = obstacle.occupancy_at_time(step), again.occupancy_at_time(step)
            if (was is None) != (now is None):
                differ(f"{file.name}: written again: obstacle {obstacle.obstacle_id} is there at step {step} only once")
            elif was is not None:
                same(f"obstacle {obstacle.obstacle_id}: centre at step {step}", was.shape.center, now.shape.center)
    for name, problem in before[1].planning_problem_dict.items():
        again = after[1].planning_problem_dict[name]
        for word in ("position", "orientation", "velocity"):
            same(f"problem {name}: {word}", getattr(problem.initial_state, word), getattr(again.initial_state, word))
        times = lambda p: [(s.time_step.start, s.time_step.end) for s in p.goal.state_list]
        same(f"problem {name}: times of its goals", times(problem), times(again))


def check_solution(replay_dataset, driver, file, scenario, problems, solution):
    """Whether CommonRoad accepts a solution that cambium writes, and reaches the goal where cambium does."""
    from commonroad.common.solution import CommonRoadSolutionReader
    from commonroad_dc.feasibility import solution_checker as checker

    subprocess.run([replay_dataset, "--tracks", file, "--driver", driver, "--solution", solution, "--out", solution.parent],
                   capture_output=True, check=True)
    if not solution.exists():  # the goal was not reached
        return False
    read = CommonRoadSolutionReader.open(str(solution))
    for test, right in (("solved_all_problems", (problems, read)), ("goal_reached", (scenario, problems, read)),
                        ("starts_at_correct_state", (read, problems)), ("solution_feasible", (read, scenario.dt, problems)),
                        ("obstacle_collision", (scenario, problems, read)), ("ego_collision", (scenario, problems, read))):
        try:
            result = getattr(checker, test)(*right)
        except checker.SolutionCheckerException as exception:
            differ(f"{file.name}: {driver}'s solution: {exception}")
            continue
        good = all(r[0] for r in result.values()) if test == "solution_feasible" else result == ("collision" not in test)
        if not good:
            differ(f"{file.name}: {driver}'s solution: {test} says {result}")
    print(f"{file.name}: {driver}'s solution was checked")
    solution.unlink()
    return True


def skip(reason):
    print("skipped:", reason)
    sys.exit(0)


def use_packages(venv, packages):
    """Goes on as a program of a virtual environment that has them."""
    python = venv / "bin" / "python"
    if Path(sys.prefix).resolve() == venv.resolve():
        return
    for command in ([sys.executable, "-m", "venv", venv], [python, "-m", "pip", "install", "--quiet", *packages]):
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            last = (done.stderr + done.stdout).strip().splitlines()[-1:]
            skip(f"{' and '.join(packages)} cannot be installed: {''.join(last)}")
    os.execv(python, [python, *sys.argv])


def main():
    kind, venv, network, replay_dataset = sys.argv[1], *map(Path, sys.argv[2:5])
    corpus = Path(os.environ.get("CAMBIUM_CORPUS") or Path(__file__).resolve().parents[2].parent / "shared")
    if not (corpus / "lanelet2").exists():
        skip("no corpus: set CAMBIUM_CORPUS")
    # The checker of 2025 does not know the modules of commonroad-io 2026.
    use_packages(venv, {"lanelet2": ["lanelet2"],
                        "commonroad": ["commonroad-io<2026", "commonroad-drivability-checker"]}[kind])
    try:
        if kind == "lanelet2":
            compare_lanelet2(network, corpus)
        else:
            compare_commonroad(network, corpus, replay_dataset)
    except ImportError as error:
        skip(str(error))
    sys.exit(1 if differences else 0)


main()
