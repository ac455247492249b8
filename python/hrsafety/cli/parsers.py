"""Parsers of the command line: commands, options and their help."""

from __future__ import annotations

import argparse
import re
from typing import Any, NoReturn

from hrsafety import __version__
from hrsafety._words import meant
from hrsafety.cli import examples
from hrsafety.cli.completion import SHELLS, PrintCompletion
from hrsafety.cli.exit_codes import MEANINGS, WARNED
from hrsafety.errors import HrsafetyError

__all__ = ["LAW_NAMES", "UsageError", "parser"]

LAW_NAMES = (
    *(
        "virtual-force-field",
        "masoud",
        "ge-cui",
        "khatib",
        "borenstein-koren",
        "virtual-impedance",
        "velocity-obstacle",
    ),
    *("optimal-reciprocal-collision-avoidance", "rapidly-exploring-random-tree", "field-d-star"),
    *("social-force", "dynamic-window", "dwb", "regulated-pure-pursuit", "path-integral"),
)
"""Laws of `hrsafety.scenarios.laws`, named here so that ``--help`` need not load them."""

SUITE_NAMES = (
    *("s4", "s5", "crowd", "recordings", "adversary", "barn", "dynabarn", "dynabarn3"),
    *("circle_crossing", "circle_crossing_unseen", "antipodal", "corridor", "crossing", "bottleneck", "scenes"),
    *("unknown_barn", "dead_ends", "hidden_people"),
)
"""Suites of `hrsafety.benchmarks`, named here so that ``--help`` need not load them."""
ARENA_LAWS = (
    "straight",
    "social_force",
    "field",
    "orca(horizon=2,margin=0.05)",
    "velocity_obstacle",
    "regulated_pure_pursuit",
    "dynamic_window",
    "orca(horizon=2,margin=0.05)+shield+yielding",
    "field+shield+yielding",
    "straight+barrier",
    "straight+collision_cone",
    "orca(horizon=2,margin=0.05)+barrier",
)
"""Entries of the arena without others."""

STARTERS = {
    "scenario": "my_first_crossing.toml",
    "foam": "foam_design.toml",
    "gains": "gain_study.toml",
    "sweep": "impact_sweep.toml",
    "run_sweep": "run_sweep.toml",
    "contact": "cell.toml",
    "program": "robot_program.toml",
    "world": "people_in_a_hall.toml",
}
"""Files to start from, by the word that ``hrsafety init`` takes."""

_CHOICE = re.compile(r"invalid choice: '([^']*)' \(choose from (.*)\)")


class UsageError(HrsafetyError):
    """The command line itself is wrong."""


class _Parser(argparse.ArgumentParser):
    """Parser whose errors are exceptions, so that all errors look the same."""

    def error(self, message: str) -> NoReturn:
        """Raise instead of printing the usage and leaving; a word near a choice gets a question."""
        choice = _CHOICE.search(message)
        near = meant(choice[1], re.findall(r"[\w-]+", choice[2])) if choice else None
        raise UsageError(f"{message}{f'; {near}' if near else ''} (see {self.prog} --help)")

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Refuse what is left over here, where the options that may have been meant are known."""
        found, rest = super().parse_known_args(args, namespace)
        if rest:
            near = meant(rest[0].partition("=")[0], self._option_string_actions) if rest[0].startswith("-") else None
            if near is None and f"--{rest[0]}" in self._option_string_actions:
                near = f"did you mean --{rest[0]}?"
            self.error(f"unrecognized arguments: {' '.join(rest)}{f'; {near}' if near else ''}")
        return found, rest


def _number(text: str) -> float:
    """Return a number, or say what is wrong with it."""
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a number, got {text[:40]!r}{_advice(text)}") from None


def _advice(text: str) -> str:
    """Return how a number on the command line is written."""
    several = re.fullmatch(r"[-+.\deE]+([,; ]+[-+.\deE]+)+", text.strip())
    if several and not re.fullmatch(r"\d+,\d+", text.strip()):
        return "; write blanks between several numbers, without quotes"
    if "," in text:
        return "; decimals need a point"
    return "; numbers have no units" if re.match(r"[-+.\d]", text) else ""


def _count(text: str) -> int:
    """Return a whole number, or say what is wrong with it."""
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be an integer, got {text[:40]!r}") from None


def parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command line."""
    whole = _Parser(
        prog="hrsafety",
        description="Robots that work near people: simulate, score, reproduce.",
        epilog=_exit_codes(),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    whole.add_argument("--version", action="version", version=f"hrsafety {__version__}")
    whole.add_argument(
        "--print-completion",
        choices=SHELLS,
        action=PrintCompletion,
        default=argparse.SUPPRESS,
        help="print the completion of this command line for a shell",
    )
    commands = whole.add_subparsers(dest="command", required=True, metavar="COMMAND")
    _add_reproduce(commands)
    _add_simulate(commands)
    _add_people(commands)
    _add_foam(commands)
    _add_optimize(commands)
    _add_sweep(commands)
    _add_arm(commands)
    _add_contact(commands)
    _add_program(commands)
    _add_judge(commands)
    _add_record(commands)
    _add_benchmark(commands)
    _add_arena(commands)
    _add_ros(commands)
    _add_zones(commands)
    _add_play(commands)
    _add_init(commands)
    _add_validate(commands)
    _add_command(
        commands, "info", summary="show versions, machine and which extras are installed", example=examples.INFO
    )
    return whole


def _exit_codes() -> str:
    return "\n".join(["exit codes:", *(f"  {code:>3}  {meaning}" for code, meaning in MEANINGS.items())])


def _add_shared(parser: argparse.ArgumentParser) -> None:
    """Add what every command has that reports: its results as JSON, and warnings as an exit code."""
    parser.add_argument("--json", metavar="FILE", help="all results as JSON")
    _add_strict(parser)


def _add_mcap(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--mcap", metavar="FILE.mcap", help="the run for viewers of robot logs")


def _add_strict(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--strict",
        action="store_true",
        help=f"exit with code {WARNED} after everything was written if there are warnings",
    )


def _add_command(commands: Any, name: str, *, summary: str, example: str) -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = commands.add_parser(
        name,
        help=summary,
        description=f"{summary[0].upper()}{summary[1:]}.",
        epilog=example,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    return parser


def _add_reproduce(commands: Any) -> None:
    parser = _add_command(
        commands,
        "reproduce",
        summary="make every published table and figure again, measured beside printed",
        example=examples.REPRODUCE,
    )
    parser.add_argument("--only", metavar="NAME", action="append", help="make this part only; can be repeated")
    parser.add_argument("--out", metavar="DIR", default="reproduction", help="folder to write into [%(default)s]")


def _add_simulate(commands: Any) -> None:
    parser = _add_command(
        commands,
        "simulate",
        summary="run a robot in a scenario file or across recorded people",
        example=examples.SIMULATE,
    )
    parser.add_argument("scenario", nargs="?", metavar="SCENARIO.toml", help="scenario file")
    parser.add_argument("--out", metavar="DIR", help="folder for a page, tables (CSV) and pictures")
    _add_shared(parser)
    parser.add_argument("--animate", metavar="FILE", help="animation of a run, .gif or .mp4")
    _add_mcap(parser)
    parser.add_argument(
        "--fail-on",
        metavar="WORDS",
        help="exit with code 3, after everything was written, if in any run one of these happened: contact, "
        "moving_contact (the robot moved), timed_out, stopped, diverged, not_arrived (also after a contact), any "
        "(anything but an arrival without a contact); several with commas between. Without it the last line says how "
        "the runs ended",
    )
    law = parser.add_argument_group("law (what is not given comes from the scenario file, else from the defaults)")
    law.add_argument(
        "--law", metavar="NAME", help=f"{', '.join(LAW_NAMES)}; or short: vff, vo, rrt, dstar, orca and others"
    )
    law.add_argument(
        "--gains",
        nargs="+",
        type=_number,
        metavar="K",
        help="numbers of the law in its order; of the virtual force field K1 K3 K5 b in N/m, N/m, N/m^2, s: "
        "attraction, repulsion, detour, and damping of each as a share of its gain",
    )
    law.add_argument("--stabilizing", choices=["off", "capped", "full"], help="stabilizing force")
    law.add_argument(
        "--safe", action="store_true", help="put a shield (people up to 1.6 m/s) and yielding around the law"
    )
    stepping = parser.add_argument_group("stepping")
    stepping.add_argument(
        "--integrator", choices=["semi_implicit_euler", "rk4"], default="semi_implicit_euler", help="[%(default)s]"
    )
    stepping.add_argument("--step", type=_number, default=0.01, metavar="S", help="motion step in s [%(default)s]")
    stepping.add_argument(
        "--no-hold", dest="hold", action="store_false", help="compute the force at every step, not every control period"
    )
    people = parser.add_argument_group("recorded people (instead of a scenario file)")
    people.add_argument(
        "--people", metavar="FILE", help="recorded people to cross, in any layout that people info reads"
    )
    _add_people_file(people)
    people.add_argument("--runs", type=_count, metavar="N", help="number of start times [24]")
    people.add_argument(
        "--selection", choices=["busiest", "even"], help="start times with most traffic, or evenly spaced [busiest]"
    )
    people.add_argument(
        "--animate-run", type=_count, metavar="K", help="animate run K, not the one that met most people"
    )


def _add_people_file(parser: Any, *, smooth: bool = True) -> None:
    """Add what a file of recorded people may not say itself."""
    parser.add_argument("--format", metavar="NAME", help="format of the file [by its contents]")
    parser.add_argument("--fps", type=_number, metavar="F", help="frames per second of a file that counts frames")
    parser.add_argument("--step-s", type=_number, metavar="S", help="instead: time in s between two rows of a person")
    parser.add_argument("--unit", metavar="U", help="unit of positions: m, cm, mm, km")
    parser.add_argument("--scale", type=_number, metavar="M", help="instead: meters of a unit, for example of a pixel")
    parser.add_argument("--homography", metavar="FILE", help="instead: 3 by 3 matrix from pixels to meters, as text")
    parser.add_argument(
        "--columns",
        metavar="NAMES",
        help="names of all columns, as 'id frame x_cm y_cm', or of some, as number=id,t=frame",
    )
    parser.add_argument("--classes", metavar="A,B,...", help="road users that are taken as people [pedestrian]")
    parser.add_argument("--relabel", action="store_true", help="exchange ids that were exchanged")
    if smooth:
        parser.add_argument("--smooth", type=_number, metavar="S", help="fit positions over S s, which takes noise out")


def _add_people(commands: Any) -> None:
    parser = _add_command(
        commands,
        "people",
        summary="show what a file of recorded people holds, or write it for another program",
        example=examples.PEOPLE,
    )
    kinds = parser.add_subparsers(dest="task", required=True, metavar="info|convert")
    info = _add_command(kinds, "info", summary="show format, rate, people and doubts", example=examples.PEOPLE)
    convert = _add_command(kinds, "convert", summary="write the people for another program", example=examples.PEOPLE)
    for each in (info, convert):
        each.add_argument("file", metavar="FILE", help="recorded people")
    convert.add_argument(
        "out", metavar="OUT", help="file to write; .csv, .txt, .sqlite, .ndjson or .json tells its format"
    )
    for each in (info, convert):
        _add_shared(each)
        _add_people_file(each.add_argument_group("what the file may not say"))
    convert.add_argument(
        "--to", metavar="NAME", help="table, petrack, jupedsim-sqlite, trajnet++ or socnavdata [by OUT]"
    )
    convert.add_argument(
        "--out-fps", type=_number, metavar="F", help="frames per second to write, of a file with times"
    )
    convert.add_argument("--renumber", action="store_true", help="give people numbers where a format has no names")


def _add_foam(commands: Any) -> None:
    parser = _add_command(
        commands,
        "foam",
        summary="find the foam coverings that make a manipulator safe, and judge given ones",
        example=examples.FOAM,
    )
    parser.add_argument("design", metavar="DESIGN.toml", help="foam design file")
    parser.add_argument("--out", metavar="DIR", default="foam", help="folder to write into [%(default)s]")
    _add_shared(parser)


def _add_pdf(parser: argparse.ArgumentParser) -> None:
    """Add the option of commands whose page is handed over on paper."""
    parser.add_argument("--pdf", action="store_true", help="write the page as PDF, too, by Chromium or WeasyPrint")


def _add_record(commands: Any) -> None:
    parser = _add_command(
        commands,
        "record",
        summary="judge measured contacts: acceleration of a head, contact force, pressure of a foil",
        example=examples.RECORD,
    )
    parser.add_argument("files", nargs="+", metavar="FILE", help="records of one load; several are repetitions")
    parser.add_argument("--kind", required=True, choices=("head", "force", "pressure"), help="what was measured")
    parser.add_argument("--out", metavar="DIR", help="folder for a page and pictures")
    _add_pdf(parser)
    _add_shared(parser)
    files = parser.add_argument_group("what a file may not say")
    files.add_argument("--time", metavar="COLUMN", help="column of times in s [found]")
    files.add_argument("--columns", metavar="A,B,...", help="columns that are judged [those with a unit of the kind]")
    files.add_argument("--unit", metavar="UNIT", help="unit of columns without one")
    head = parser.add_argument_group("--kind head")
    head.add_argument("--filter", type=_count, metavar="CFC", help="channel class: 60, 180, 600 or 1000 [none]")
    head.add_argument("--peak-g", type=_number, metavar="G", help="limit of the peak in g")
    head.add_argument("--hic15", type=_number, metavar="H", help="limit of HIC15")
    head.add_argument("--hic36", type=_number, metavar="H", help="limit of HIC36")
    head.add_argument("--clip-3ms-g", type=_number, metavar="G", help="limit of the level held for 3 ms in g")
    force = parser.add_argument_group("--kind force")
    force.add_argument("--transient", type=_number, metavar="N", help="limit of transient forces in N")
    force.add_argument("--quasi-static", type=_number, metavar="N", help="limit of quasi-static forces in N")
    force.add_argument("--free", action="store_true", help="the body part was free to move [clamped]")
    force.add_argument("--device", metavar="DEVICE.toml", help="spring, range and uncertainty of the device")
    force.add_argument("--region-spring", type=_number, metavar="K", help="spring constant of the region in N/m")
    foil = parser.add_argument_group("--kind pressure")
    foil.add_argument("--pitch", type=_number, metavar="M", help="distance of neighboring cells in m")
    foil.add_argument("--row", type=_count, metavar="N", help="cells of a row")
    foil.add_argument("--pressure", type=_number, metavar="PA", help="limit in Pa")
    foil.add_argument("--patch", action="store_true", help="judge the mean over 1 cm2, not the largest cell")
    cell = parser.add_argument_group("--kind force and pressure")
    cell.add_argument("--predict", metavar="FILE.toml", help="cell or program with the prediction beside the records")
    cell.add_argument("--plan-row", type=_count, metavar="N", help="row of its measurement plan, from 1")
    every = parser.add_argument_group("all kinds")
    every.add_argument("--full-scale", type=_number, metavar="X", help="full scale of the channel in SI units")
    every.add_argument(
        "--uncertainty", type=_number, metavar="U", help="standard uncertainty of the device [that of --device, or 0]"
    )


def _add_optimize(commands: Any) -> None:
    parser = _add_command(
        commands,
        "optimize",
        summary="search the gains that perform best in given scenarios",
        example=examples.OPTIMIZE,
    )
    parser.add_argument("study", metavar="STUDY.toml", help="gain study file")
    parser.add_argument("--out", metavar="DIR", default="gains", help="folder to write into [%(default)s]")
    parser.add_argument("--resume", action="store_true", help="resume an interrupted search, if there is one")
    _add_shared(parser)
    parser.add_argument("--threads", type=_count, metavar="N", help="number of threads [all cores]")


def _add_sweep(commands: Any) -> None:
    parser = _add_command(
        commands,
        "sweep",
        summary="compute impacts or runs over ranges of their parameters",
        example=examples.SWEEP,
    )
    parser.add_argument("study", metavar="STUDY.toml", help="sweep file")
    parser.add_argument(
        "--out", metavar="DIR", default="sweep", help="folder to write into, or to resume in [%(default)s]"
    )
    parser.add_argument("--table", metavar="FILE", help="all rows as one file, .parquet, .npz or .csv")
    parser.add_argument(
        "--outputs", metavar="A,B,...", help="columns to keep besides the axes [those of the file, or all]"
    )
    parser.add_argument(
        "--store", choices=("npz", "parquet"), help="files of the chunks; Parquet is smaller [those of DIR, or npz]"
    )
    parser.add_argument(
        "--chunks",
        metavar="A:B|I/N",
        help="compute only the chunks A to B-1, or the I-th of N parts; several processes fill one folder",
    )
    parser.add_argument("--dry-run", action="store_true", help="show rows, size and time, and write nothing")
    _add_shared(parser)
    parser.add_argument(
        "--threads", type=_count, metavar="N", help="threads of one chunk [all cores; one with workers]"
    )
    parser.add_argument("--workers", type=_count, metavar="N", help="compute chunks in so many processes")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="compute chunks on the Dask cluster of this scheduler")


def _add_arm(commands: Any) -> None:
    parser = _add_command(
        commands,
        "arm",
        summary="show the mass of a point of an arm by pose and direction",
        example=examples.ARM,
    )
    parser.add_argument("robot", metavar="ROBOT.urdf", help="URDF of the arm, macros expanded")
    parser.add_argument("--out", metavar="DIR", default="arm", help="folder to write into [%(default)s]")
    _add_pdf(parser)
    _add_shared(parser)
    place = parser.add_argument_group("point")
    place.add_argument("--link", metavar="NAME", help="link that the point is fixed to [the last one that moves]")
    place.add_argument(
        "--point", nargs=3, type=_number, default=(0.0, 0.0, 0.0), metavar=("X", "Y", "Z"), help="in its frame, in m"
    )
    place.add_argument("--direction", nargs=3, type=_number, metavar=("X", "Y", "Z"), help="one more, in world axes")
    poses = parser.add_argument_group("poses")
    poses.add_argument("--joint", metavar="NAME=VALUE", action="append", help="value in rad or m; can be repeated")
    poses.add_argument("--poses", metavar="FILE.csv", help="table of poses whose header names joints")
    poses.add_argument("--samples", type=_count, default=5, metavar="N", help="drawn poses [%(default)s]")
    poses.add_argument("--seed", type=_count, default=0, metavar="N", help="of the draws [%(default)s]")
    poses.add_argument("--no-limits", action="store_true", help="take values outside the limits of the joints")
    arm = parser.add_argument_group("arm (what a URDF does not hold)")
    arm.add_argument("--payload", type=_number, metavar="KG", help="mass that the arm carries, as a point")
    arm.add_argument("--payload-link", metavar="NAME", help="link that carries it [that of --link]")
    arm.add_argument(
        "--payload-center", nargs=3, type=_number, default=(0.0, 0.0, 0.0), metavar=("X", "Y", "Z"), help="in its frame"
    )
    arm.add_argument(
        "--armature", metavar="NAME=VALUE", action="append", help="reflected motor inertia in kg m^2; can be repeated"
    )
    arm.add_argument("--type-plate", type=_number, metavar="KG", help="mass on the type plate, without the payload")
    arm.add_argument(
        "--repair-inertia", action="store_true", help="replace inertias that no body has by the nearest ones"
    )
    arm.add_argument("--lock", metavar="NAME", action="append", help="joint that keeps its value; can be repeated")


def _add_contact(commands: Any) -> None:
    parser = _add_command(
        commands,
        "contact",
        summary="judge planned contacts with people and write a report to hand over",
        example=examples.CONTACT,
    )
    parser.add_argument("cell", nargs="?", default="cell.toml", metavar="CELL.toml", help="cell file [%(default)s]")
    parser.add_argument("--init", action="store_true", help="write a commented cell file to start from")
    parser.add_argument("--out", metavar="DIR", help="folder to write into [report]")
    _add_pdf(parser)
    parser.add_argument("--date", metavar="YYYY-MM-DD", help="date that the page prints [SOURCE_DATE_EPOCH, else none]")
    _add_shared(parser)


def _add_program(commands: Any) -> None:
    parser = _add_command(
        commands,
        "program",
        summary="find how fast a robot program may be beside people, and what that costs in cycle time",
        example=examples.PROGRAM,
    )
    parser.add_argument(
        "file", nargs="?", default="robot_program.toml", metavar="FILE.toml", help="program [%(default)s]"
    )
    parser.add_argument("--out", metavar="DIR", help="folder to write into [program]")
    _add_pdf(parser)
    parser.add_argument("--date", metavar="YYYY-MM-DD", help="date that the page prints [SOURCE_DATE_EPOCH, else none]")
    _add_shared(parser)


def _add_judge(commands: Any) -> None:
    parser = _add_command(
        commands,
        "judge",
        summary="judge the log of a robot among people: contacts, rules of permission, metrics",
        example=examples.JUDGE,
    )
    parser.add_argument("log", metavar="LOG", help="bag of ROS 1 or 2 (file or folder), TUM, EuRoC, table of odometry")
    parser.add_argument("--out", metavar="DIR", help="folder for a page, a table (CSV) and pictures")
    _add_mcap(parser)
    _add_shared(parser)
    parser.add_argument(
        "--fail-on",
        metavar="WORDS",
        help="exit with code 3, after everything was written, if one of these was found: contact, moving_contact, "
        "at_fault, wall_contact, possible_contact, broken_assumption, violated_rule, any; several with commas between",
    )
    parser.add_argument("--time", nargs=2, type=_number, metavar=("FROM", "TO"), help="part that is judged, in s [all]")
    parser.add_argument("--step", type=_number, default=0.1, metavar="S", help="between instants in s [%(default)s]")
    parser.add_argument("--moments", type=_count, default=5, metavar="N", help="number of worst moments [%(default)s]")
    robot = parser.add_argument_group("robot")
    robot.add_argument("--radius", type=_number, metavar="M", help="radius in m of a disc that covers the robot")
    robot.add_argument("--robot", metavar="ROBOT.toml", help="scenario file with the robot, and perhaps its shield")
    robot.add_argument("--params", metavar="NAV2.yaml", help="settings of Nav2 with footprint and limits")
    robot.add_argument("--robot-frame", metavar="NAME", help="frame of the robot, or topic of its poses [found]")
    robot.add_argument("--view", type=_number, metavar="RAD", help="angle ahead in which it sees people [all around]")
    robot.add_argument("--goal", nargs=2, type=_number, metavar=("X", "Y"), help="where it was going, in m")
    place = parser.add_argument_group("people and place")
    place.add_argument("--people", metavar="FILE|TOPIC", help="recorded people, or the topic that reports them [found]")
    place.add_argument(
        "--person-radius", type=_number, default=0.25, metavar="M", help="radius of people in m [%(default)s]"
    )
    place.add_argument("--map", metavar="MAP.yaml", help="map of the map server")
    place.add_argument(
        "--unknown", choices=("free", "occupied"), default="free", help="what unknown cells of --map are [%(default)s]"
    )
    place.add_argument("--frame", default="map", metavar="NAME", help="frame of the result [%(default)s]")
    place.add_argument(
        "--offset",
        metavar="TOPIC=S",
        action="append",
        help="seconds added to the stamps of a topic, or of people from a file (people=S); can be repeated",
    )
    _add_people_file(parser.add_argument_group("what a file of people may not say"), smooth=False)


def _add_benchmark(commands: Any) -> None:
    parser = _add_command(
        commands,
        "benchmark",
        summary="run laws through a fixed protocol and show the shares of success, contact and fault",
        example=examples.BENCHMARK,
    )
    _add_shared(parser)
    parser.add_argument("suite", choices=SUITE_NAMES, metavar="SUITE", help=", ".join(SUITE_NAMES))
    parser.add_argument(
        "--laws",
        nargs="+",
        metavar="LAW",
        help="laws with their parts, as field or orca+shield+yielding [of the suite]",
    )
    parser.add_argument("--cases", type=_count, metavar="N", help="number of episodes of each law [of the protocol]")
    parser.add_argument(
        "--person-speed",
        type=_number,
        default=1.6,
        metavar="V",
        help="speed of people that shields assume, in m/s [%(default)s]",
    )
    parser.add_argument(
        "--noise",
        type=_number,
        default=0.0,
        metavar="M",
        help="largest error of each coordinate of measured people, in m [%(default)s]",
    )
    parser.add_argument(
        "--latency", type=_number, default=0.0, metavar="S", help="age of their measurements, in s [%(default)s]"
    )
    parser.add_argument("--seed", type=_count, metavar="N", help="seed of the draw [of the protocol]")
    parser.add_argument("--data", metavar="DIR", help="folder with recordings (.csv), BARN or DynaBARN worlds (.json)")
    parser.add_argument("--out", metavar="DIR", help="folder for rows, tables (CSV) and a page; resumed from there")
    parser.add_argument("--threads", type=_count, metavar="N", help="number of threads [all cores]")


def _add_arena(commands: Any) -> None:
    parser = _add_command(
        commands,
        "arena",
        summary="run laws and filters through the standard scenes and show how they stand",
        example=examples.ARENA,
    )
    _add_shared(parser)
    parser.add_argument(
        "--laws",
        nargs="+",
        metavar="LAW",
        default=ARENA_LAWS,
        help="laws with their parts, as orca+shield+yielding or straight+barrier(margin=0.2) [twelve]",
    )
    parser.add_argument("--scenes", nargs="+", metavar="SCENE", help="standard scenes, as narrow_doorway [all]")
    parser.add_argument("--seeds", type=_count, default=20, metavar="N", help="seeds of each scene [%(default)s]")
    people = ("reacting", "not_reacting")
    parser.add_argument(
        "--people", nargs="+", choices=people, default=people, help="whether people notice the robot [both]"
    )
    sensing = ("exact", "noise", "noise_delay")
    parser.add_argument(
        "--sensing", nargs="+", choices=sensing, default=sensing[:1], help="how people are measured [exact]"
    )
    parser.add_argument("--out", metavar="DIR", help="folder for episodes and a page; resumed from there")
    parser.add_argument("--threads", type=_count, metavar="N", help="number of threads [all cores]")


def _add_ros(commands: Any) -> None:
    parser = _add_command(
        commands,
        "ros",
        summary="put people around a robot that is driven over ROS 2, and score it",
        example=examples.ROS,
    )
    parser.add_argument("world", metavar="WORLD.toml", help="scenario file, which may have people who react")
    parser.add_argument("--drive", action="store_true", help="be the robot's controller, under the law of the file")
    parser.add_argument(
        "--complete", action="store_true", help="with --drive: whoever is no longer among the people has left"
    )
    parser.add_argument("--out", metavar="DIR", help="folder for a page and pictures")
    _add_shared(parser)
    parser.add_argument("--fail-on", metavar="WORDS", help="exit with code 3 after these, as of hrsafety simulate")
    parser.add_argument("--seed", type=_count, metavar="N", help="seed of the people [of the file]")
    parser.add_argument("--params", metavar="NAV2.yaml", help="settings of Nav2 with footprint and limits of the robot")
    time = parser.add_argument_group("time")
    time.add_argument("--lockstep", action="store_true", help="every step waits for its velocity command")
    time.add_argument(
        "--period",
        type=_number,
        default=0.05,
        metavar="S",
        help="step of lock-step in s, that of the controller [%(default)s]",
    )
    time.add_argument("--speed", type=_number, default=1.0, metavar="X", help="times real time, else [%(default)s]")
    time.add_argument(
        "--delay", type=_number, default=0.0, metavar="S", help="time until a command is executed, in s [%(default)s]"
    )
    time.add_argument("--wait", action="store_true", help="people stand until the first velocity command comes")
    time.add_argument("--stay", action="store_true", help="continue to the time limit when the robot rests at its goal")
    topics = parser.add_argument_group("topics")
    topics.add_argument("--topic", default="cmd_vel", metavar="NAME", help="of velocity commands [%(default)s]")
    topics.add_argument(
        "--commands",
        choices=("auto", "twist", "stamped"),
        default="auto",
        help="Twist, TwistStamped, or as their publisher sends them [%(default)s]",
    )
    topics.add_argument("--beams", type=_count, default=720, metavar="N", help="of the lidar [%(default)s]")
    topics.add_argument("--range", type=_number, default=12.0, metavar="M", help="of the lidar in m [%(default)s]")
    topics.add_argument(
        "--field-of-view", type=_number, default=360.0, metavar="DEG", help="of the lidar in degrees [%(default)s]"
    )
    topics.add_argument("--resolution", type=_number, default=0.05, metavar="M", help="of the map in m [%(default)s]")


def _add_zones(commands: Any) -> None:
    parser = _add_command(
        commands,
        "zones",
        summary="write zones of a collision monitor that hold, or attack those of a file",
        example=examples.ZONES,
    )
    parser.add_argument("action", nargs="?", choices=("check",), metavar="check", help="judge the zones of a file")
    parser.add_argument("file", nargs="?", metavar="FILE.yaml", help="parameters of a collision monitor")
    parser.add_argument("--out", metavar="PATH", help="FILE.yaml for zones; of check a folder for a page and pictures")
    _add_shared(parser)

    def numbers(title: str, options: dict[str, tuple[str, str]]) -> Any:
        group = parser.add_argument_group(title)
        for name, (metavar, words) in options.items():
            group.add_argument(f"--{name}", type=_number, metavar=metavar, help=words)
        return group

    robot = numbers(
        "robot",
        {
            "max-speed": ("V", "largest commanded speed in m/s"),
            "min-speed": ("V", "largest speed backward in m/s, with its sign [0]"),
            "max-turn-rate": ("W", "largest commanded turn rate in rad/s"),
            "deceleration": ("A", "of a stop that is always reached, in m/s^2"),
            "turn-deceleration": ("A", "of turns in rad/s^2 [deceleration at the rim]"),
            "acceleration": ("A", "of the base in m/s^2 [deceleration]"),
            "build-up": ("S", "time in which the brakes build up, in s [0]"),
            "command-fall": ("A", "limit of falling commands in m/s^2, as a velocity smoother keeps it [none]"),
            "turn-command-fall": ("A", "limit of falling turn rates in rad/s^2 [none]"),
            "tracking-lag": ("S", "lag of the base behind its commands in s [0]"),
        },
    )
    robot.add_argument("--footprint", metavar="R|CORNERS", help='radius in m, or corners as "[[x, y], ...]" in m')
    robot.add_argument("--holonomic", action="store_true", help="the robot drives sideways, too")
    numbers(
        "delays",
        {
            "reaction": ("S", "from a leg in a zone until the robot begins to brake, at most, in s"),
            "scan-period": ("S", "of the scanner, a part of the reaction, in s [a third of it]"),
            "command-period": ("S", "of the commands, a part of the reaction, in s [a sixth of it]"),
        },
    )
    scanner = numbers(
        "scanner",
        {
            "beam-step-deg": ("DEG", "angle between beams in degrees"),
            "error": ("M", "largest error of measured points in m"),
            "min-range": ("M", "least range in m [0]"),
            "max-range": ("M", "largest range in m [10]"),
        },
    )
    scanner.add_argument("--scanner", nargs=2, type=_number, metavar=("X", "Y"), help="place in the base frame [0 0]")
    numbers(
        "people",
        {
            "person-speed": ("V", "largest speed of people in m/s [1.6]"),
            "leg-radius": ("M", "radius of the thinnest leg in m [0.06]"),
            "supplement": ("M", "distance in m to keep beyond, such as for what overhangs legs [0]"),
        },
    )
    made = parser.add_argument_group("zones that are written")
    made.add_argument("--ranges", type=_count, default=3, metavar="N", help="ranges of speed [%(default)s]")
    made.add_argument("--turn-ranges", type=_count, default=1, metavar="N", help="1, or 3 [%(default)s]")
    made.add_argument("--corners", type=_count, default=16, metavar="N", help="most corners of a zone [%(default)s]")
    made.add_argument("--min-points", type=_count, default=4, metavar="N", help="points that stop [%(default)s]")
    made.add_argument(
        "--all-sides", action="store_true", help="nobody reaches the robot from any side before it stands"
    )
    made.add_argument("--report", metavar="DIR", help="folder for a page and a picture of the fields")
    judged = parser.add_argument_group("zones that are checked")
    judged.add_argument("--attacks", type=_count, metavar="N", help="attacks by chance [1000]")
    judged.add_argument("--generations", type=_count, default=6, metavar="N", help="of the search [%(default)s]")
    judged.add_argument("--seed", type=_count, default=0, metavar="N", help="of the attacks [%(default)s]")
    judged.add_argument(
        "--mend", metavar="FILE.yaml", help="write the file with zones made large enough, comments kept"
    )
    judged.add_argument(
        "--fail-on",
        metavar="WORDS",
        help="exit with code 3 if the verdict is one of these: broken, not_covered, any; several with commas between",
    )


def _add_play(commands: Any) -> None:
    parser = _add_command(
        commands,
        "play",
        summary="run a world on a page of this machine, on which people and the goal can be dragged",
        example=examples.PLAY,
    )
    parser.add_argument(
        "world", nargs="?", metavar="WORLD.toml", help="scenario file, which may have people who react [a hall]"
    )
    parser.add_argument("--seed", type=_count, metavar="N", help="seed of the people [of the file]")
    parser.add_argument("--port", type=_count, default=0, metavar="N", help="port of the page [one that is free]")
    parser.add_argument("--no-browser", dest="browser", action="store_false", help="only print the address of the page")


def _starter(word: str) -> str:
    """Return the kind of file that a command reads, for those who name the command."""
    return {"simulate": "scenario", "optimize": "gains", "play": "world", "ros": "world"}.get(word, word)


def _add_init(commands: Any) -> None:
    parser = _add_command(commands, "init", summary="write a commented file to start from", example=examples.INIT)
    words = f"{', '.join(STARTERS)}, or the command that reads it"
    parser.add_argument("kind", type=_starter, choices=tuple(STARTERS), metavar="KIND", help=words)
    parser.add_argument("file", nargs="?", metavar="FILE", help="where to write it [a name of its kind]")


def _add_validate(commands: Any) -> None:
    parser = _add_command(
        commands,
        "validate",
        summary="check scenario, study, cell and arm files without running them",
        example=examples.VALIDATE,
    )
    parser.add_argument("files", nargs="+", metavar="FILE", help="files, .toml or .urdf")
    _add_strict(parser)
