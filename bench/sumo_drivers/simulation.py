"""SUMO's programs as functions: a network, traffic on it, and what its detectors and trajectories say."""

import collections
import os
import pathlib
import shutil
import statistics
import subprocess
import threading
import xml.etree.ElementTree as xml


class Error(Exception):
    """What is wrong, where, and what to do."""


class NothingObserved(Exception):
    """Why a quantity has no value: what it is a mean of did not occur."""


def program(name):
    """Path of one of SUMO's programs: below SUMO_HOME, of the package eclipse-sumo, or on the PATH."""
    homes = [os.environ["SUMO_HOME"]] if "SUMO_HOME" in os.environ else []
    try:
        import sumo

        homes.append(sumo.SUMO_HOME)
    except ImportError:
        pass
    for home in homes:
        found = shutil.which(name, path=os.path.join(home, "bin"))
        if found:
            return found
    found = shutil.which(name)
    if not found:
        raise Error(f"SUMO's program '{name}' is not here: python3 -m pip install eclipse-sumo (or apt-get install sumo)")
    return found


def version():
    return subprocess.run([program("sumo"), "--version"], capture_output=True, text=True).stdout.split("\n")[0]


is_interrupted = threading.Event()  # nothing more is to be run


def call(name, *options):
    if is_interrupted.is_set():
        raise Error("interrupted")
    done = subprocess.run([program(name), *map(str, options)], capture_output=True, text=True)
    if done.returncode != 0:
        raise Error(f"{name} {' '.join(map(str, options))}\nfailed: {done.stderr.strip()}\nreport this as a bug")


def element(tag, **attributes):
    """One element of a file for SUMO; `from_` writes `from`."""
    said = " ".join(f'{key.rstrip("_")}="{value}"' for key, value in attributes.items())
    return f"<{tag} {said}/>"


Passage = collections.namedtuple("Passage", "time speed lane kind vehicle")  # a front end at a detector [s, m/s]
Sample = collections.namedtuple("Sample", "time place speed angle lane")  # of a trajectory; place: on its lane [m]

# Where each vehicle comes from a distribution of types: SUMO's default car, and its default lorry.
CARS = '<vType id="car" vClass="passenger"/>'


def cars_and_trucks(share, name="people"):
    """Types of which `share` are lorries."""
    return (
        f'<vTypeDistribution id="{name}"><vType id="{name}_car" vClass="passenger" probability="{1 - share}"/>'
        f'<vType id="{name}_truck" vClass="truck" probability="{share}"/></vTypeDistribution>'
    )


class Simulation:
    """Traffic on a network, in a folder for the files."""

    def __init__(self, folder, settings):
        self.folder, self.settings = pathlib.Path(folder), settings
        self.detectors = []

    def path(self, name):
        return str(self.folder / name)

    def write(self, name, root, elements):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(f"<{root}>\n" + "\n".join(elements) + f"\n</{root}>\n")
        return self.path(name)

    def build(self, nodes, edges, connections=(), more=(), **options):
        """A network of elements `node`, `edge` and `connection`; `more` goes into a file of edges' roundabouts or so."""
        words = ["-n", self.write("nodes.xml", "nodes", nodes), "-e", self.write("edges.xml", "edges", [*edges, *more])]
        if connections:
            words += ["-x", self.write("connections.xml", "connections", connections)]
        for key, value in options.items():
            words += [f"--{key.replace('__', '.').replace('_', '-')}", value]
        call("netconvert", *words, "-o", self.path("net.xml"), "--no-turnarounds", "true")

    def detect(self, lane, place):
        """A detector at this place [m] of a lane; below 0: before its end."""
        self.detectors.append(
            element("instantInductionLoop", id=f"{lane}@{place}", lane=lane, pos=place, file=self.path("passages.xml"))
        )

    def run(self, traffic, duration, seed, trajectories=False, additional=(), **options):
        """Drives `traffic`, elements of a file of routes in order of departure, for `duration` [s]."""
        words = ["-n", self.path("net.xml"), "-r", self.write("routes.xml", "routes", traffic)]
        words += ["-a", self.write("additional.xml", "additional", [*self.detectors, *additional])]
        words += ["--end", duration, "--seed", seed % 2**31, "--step-length", self.settings.step]
        words += ["--eager-insert", "true", "--max-depart-delay", 60]  # of a queue that does not end, the rest stays away
        words += ["--time-to-teleport", "-1", "--no-step-log", "true", "--no-warnings", "true", "--xml-validation", "never"]
        if trajectories:
            words += ["--fcd-output", self.path("trajectories.xml"), "--fcd-output.attributes", "pos,speed,angle,lane"]
        for key, value in options.items():
            words += [f"--{key.replace('__', '.').replace('_', '-')}", value]
        call("sumo", *words)

    def passages(self, since=0.0):
        """In order of time."""
        found = []
        for _, one in xml.iterparse(self.path("passages.xml")):
            if one.tag == "instantOut" and one.get("state") == "enter" and float(one.get("time")) >= since:
                numbers = (float(one.get(key)) for key in ("time", "speed"))
                found.append(Passage(*numbers, *(one.get(key) for key in ("id", "type", "vehID"))))
            one.clear()
        return sorted(found)

    def samples(self):
        """Of all trajectories, one after the other in time: vehicle and `Sample`."""
        time = 0.0
        for event, one in xml.iterparse(self.path("trajectories.xml"), events=("start", "end")):
            if event == "start" and one.tag == "timestep":
                time = float(one.get("time"))
            elif event == "end" and one.tag == "vehicle":
                numbers = (float(one.get(key)) for key in ("pos", "speed", "angle"))
                yield one.get("id"), Sample(time, *numbers, one.get("lane"))
            elif event == "end" and one.tag == "timestep":
                one.clear()

    def trajectories(self):
        """Samples of each vehicle."""
        found = collections.defaultdict(list)
        for vehicle, sample in self.samples():
            found[vehicle].append(sample)
        return found


def flow(name, route, per_hour, end, type_="car", **more):
    """Vehicles with exponential headways from time 0 to `end` [s]."""
    # A speed of "avg" lets more enter than "max", the desired one, which waits for long gaps.
    period = f"exp({per_hour / 3600.0})"
    return element("flow", id=name, type=type_, route=route, begin=0, end=end, period=period, departSpeed="avg", **more)


def space_mean_speed(passages):
    """[m/s]: the harmonic mean of those that pass."""
    return 1.0 / mean([1.0 / max(0.1, one.speed) for one in passages])


def follower_headways(passages, longest=3.0):
    """[s] of vehicles up to `longest` [s] behind another one, and about as fast (2 m/s)."""
    found, last = [], {}
    for one in passages:
        before = last.get(one.lane)
        if before and one.time - before.time < longest and abs(one.speed - before.speed) < 2.0:
            found.append(one.time - before.time)
        last[one.lane] = one
    return found


def mean(values):
    if not values:
        raise NothingObserved("nothing occurred that it is a mean of")
    return statistics.fmean(values)


def quantile(values, share):
    """With linear interpolation between the sorted values."""
    if not values:
        raise NothingObserved("nothing occurred that it is a quantile of")
    values = sorted(values)
    at = share * (len(values) - 1)
    low = int(at)
    high = min(low + 1, len(values) - 1)
    return values[low] + (at - low) * (values[high] - values[low])
