#!/usr/bin/env python3
"""Measures SUMO's default drivers as `examples/run field` measures cambium's, and makes the table of both.

    bench/sumo_field.py --json FILE --field --into README   # all of it; or step by step:

    examples/run field --json FILE
    bench/sumo_field.py --json FILE                 # fills in what SUMO's drivers do
    bench/sumo_field.py --json FILE --markdown      # prints the table
    bench/sumo_field.py --json FILE --into README   # puts it between <!-- field --> and <!-- /field -->
"""

import argparse
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from sumo_drivers import motorway, simulation, town  # noqa: E402
from sumo_drivers.simulation import Error  # noqa: E402

EXPERIMENTS = {**motorway.EXPERIMENTS, **town.EXPERIMENTS}  # name -> what measures, and what it measures
KEYS = ("quantity", "people", "cambium", "sumo", "unit", "source")
BEGIN, END = "<!-- field -->", "<!-- /field -->"
FIELD = [os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "run"), "field"]


def quantity(row):
    """Without the kilometres that cambium's drivers were observed for."""
    return re.sub(r", in \d+ km$", "", row["quantity"])


def read(path):
    try:
        with open(path, encoding="utf-8") as file:
            said = json.load(file)
    except OSError as error:
        raise Error(f"{path}: cannot be read ({error.strerror}): write it with examples/run field --json {path}")
    except ValueError as error:
        raise Error(f"{path}: is not JSON ({error}): name a file that examples/run field --json has written, or a new one")
    rows = said.get("rows") if isinstance(said, dict) else None
    if not isinstance(rows, list) or not all(isinstance(row, dict) and all(key in row for key in KEYS) for row in rows):
        raise Error(
            f"{path}: has no rows of {', '.join(KEYS)}: name a file that examples/run field --json has written, or a new one"
        )
    for row in rows:
        band = row["people"] if isinstance(row["people"], list) else [row["people"]] * 2
        if len(band) != 2 or not all(isinstance(number, (int, float)) for number in band):
            raise Error(f"{path}: '{row['quantity']}': people is to be a number or [low, high], not {row['people']}")
    return said


def write(path, text):
    try:
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        raise Error(f"{path}: cannot be written ({error.strerror}): name another file, or make it writable")


def rows_of(said, path, only):
    """Experiment -> the rows that it measures, in its order. Throws for a row that nothing here measures."""
    found = {}
    for row in said["rows"]:
        name = next((name for name, (_, measured) in EXPERIMENTS.items() if quantity(row) in measured), None)
        if name is None:
            raise Error(
                f"{path}: '{row['quantity']}' is not measured here: enter it in EXPERIMENTS of bench/sumo_drivers, or "
                "write the file with the examples/run field of this checkout"
            )
        found.setdefault(name, []).append(row)
    if only and only not in EXPERIMENTS:
        known = ", ".join(f"'{name}'" for name in EXPERIMENTS)
        raise Error(f"--only {only}: there is no such experiment: choose one of {known}")
    if only and only not in found:
        raise Error(f"{path}: has no row of '{only}': write it with examples/run field --only '{only}' --json {path}")
    return {only: found[only]} if only else found


def measure(name, settings):
    """The values in the order of the experiment's quantities, or why there are none."""
    begin = time.time()
    with tempfile.TemporaryDirectory() as folder:
        try:
            values = EXPERIMENTS[name][0](settings, folder)
        except simulation.NothingObserved as nothing:
            return f"'{name}' stays null: {nothing}"
    print(f"{name}: {time.time() - begin:.0f} s", file=sys.stderr)
    return values


def measure_cambium(path, settings):
    """Writes the file as `examples/run field` does, whose status is 1 where a row is out of its band, or it was not built."""
    only = ["--only", settings.only] if settings.only else []
    with tempfile.TemporaryDirectory() as folder:
        new = os.path.join(folder, "rows.json")
        words = [*FIELD, "--json", new, "--seed", str(settings.seed), "--threads", str(settings.threads), *only]
        status = subprocess.run(words, stdout=subprocess.DEVNULL).returncode
        if status not in (0, 1) or not os.path.exists(new):
            raise Error(f"{' '.join(words)}: failed; what it says stands above")
        with open(new, encoding="utf-8") as file:
            write(path, file.read())


def fill(said, path, settings):
    """Measures what the file has rows of. Returns why some stay null."""
    wanted, why = rows_of(said, path, settings.only), []
    said["sumo_version"], said["sumo_step"] = simulation.version(), settings.step
    with concurrent.futures.ThreadPoolExecutor(settings.threads) as pool:
        try:
            results = list(pool.map(lambda name: measure(name, settings), wanted))
        except KeyboardInterrupt:
            simulation.is_interrupted.set()  # each ends at its next run
            pool.shutdown(cancel_futures=True)
            raise
    for (name, rows), values in zip(wanted.items(), results):
        if isinstance(values, str):
            why.append(values)
            values = [None] * len(EXPERIMENTS[name][1])
        left = list(zip(EXPERIMENTS[name][1], values))  # a quantity may occur more than once: in the same order
        for row in rows:
            at = next((i for i, (measured, _) in enumerate(left) if measured == quantity(row)), None)
            if at is None:
                raise Error(f"{path}: '{row['quantity']}' stands there too often: write it with examples/run field")
            row["sumo"] = left.pop(at)[1]
    return why


def in_words(value):
    if value is None:
        return "–"
    return f"{value:.0f}" if abs(value) >= 1000.0 else f"{value:.4g}"


def table(rows):
    """In Markdown; what lies outside people's band is bold."""
    lines = ["| quantity | people | cambium | SUMO | unit | source |", "|---|---|---|---|---|---|"]
    for row in rows:
        low, high = row["people"] if isinstance(row["people"], list) else [row["people"]] * 2
        people = in_words(low) if low == high else f"{in_words(low)} to {in_words(high)}"
        values = [row[key] for key in ("cambium", "sumo")]
        is_outside = [value is not None and low != high and not low <= value <= high for value in values]
        said = [f"**{in_words(value)}**" if outside else in_words(value) for value, outside in zip(values, is_outside)]
        cells = [row["quantity"], people, *said, row["unit"], row["source"]]
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def around_table(path):
    """What stands before and behind the two lines of a file."""
    try:
        with open(path, encoding="utf-8") as file:
            old = file.read()
    except OSError as error:
        raise Error(f"{path}: cannot be read ({error.strerror}): name a file with the lines {BEGIN} and {END}")
    parts = re.split(rf"^({re.escape(BEGIN)}|{re.escape(END)})$", old, flags=re.M)
    if parts[1::2] != [BEGIN, END]:
        raise Error(f"{path}: needs one line {BEGIN} and, below it, one line {END}: enter them where the table is to stand")
    return parts[0], parts[4]


def arguments(words):
    def within(kind, low, high):
        def number(word):
            value = kind(word)
            if not low <= value <= high:
                raise argparse.ArgumentTypeError(f"{word} is not between {low} and {high}")
            return value

        number.__name__ = "number"  # in messages of argparse
        return number

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", metavar="FILE", required=True, help="of examples/run field; is filled in")
    parser.add_argument("--seed", metavar="N", type=within(int, 0, 10**9), default=1, help="of the drivers and the traffic")
    parser.add_argument("--only", metavar="NAME", help="run only this experiment, such as 'queue'")
    parser.add_argument(
        "--step", metavar="SECONDS", type=within(float, 0.01, 1.0), default=0.1, help="SUMO's step; its own default is 1"
    )
    parser.add_argument("--threads", metavar="N", type=within(int, 1, 1024), default=os.cpu_count(), help="runs at a time")
    parser.add_argument("--field", action="store_true", help="first write the file by examples/run field")
    parser.add_argument("--markdown", action="store_true", help="print the table of the file; without --field, measure nothing")
    parser.add_argument("--into", metavar="FILE", help="put it into this Markdown file; without --field, measure nothing")
    return parser.parse_args(words)


def main(words):
    settings = arguments(words)
    if settings.into:
        before, behind = around_table(settings.into)
        if settings.only:
            raise Error("--into: puts the whole table there: leave out --only")
    if settings.field:
        if os.path.exists(settings.json):
            read(settings.json)  # overwrites nothing else
        simulation.version()  # fails at once where SUMO is not installed, not after minutes
        measure_cambium(settings.json, settings)
    said = read(settings.json)
    if settings.field or not (settings.markdown or settings.into):
        for sentence in fill(said, settings.json, settings):
            print(sentence, file=sys.stderr)
        write(settings.json, json.dumps(said, indent=1, ensure_ascii=False) + "\n")
    if settings.markdown:
        print(table(said["rows"]), end="")
    if settings.into:
        write(settings.into, f"{before}{BEGIN}\n{table(said['rows'])}{END}{behind}")


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except Error as error:
        sys.exit(f"sumo_field.py: {error}")
    except KeyboardInterrupt:
        sys.exit("sumo_field.py: interrupted; no file has changed")
