"""mmweaver dataset --activities: a labelled set in the user's own rooms."""

import shlex
import sys
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any

from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from mmweaver.cli.dataset import Options
    from mmweaver.datasets.build_set import SetBuilder


def run_activity_set(asked: "Options") -> int:
    """Generates the missing sequences of a set, and prints the verdict of its leak report.

    Args:
        asked: Options of the command.

    Returns:
        Exit status.

    Raises:
        InputError: For options or files that cannot be used.
    """
    if asked.from_results is not None:
        return _run_from_results(asked)
    from mmweaver.core.safe_files.safe_text import read_text
    from mmweaver.datasets.build_set import SetBuilder, SetOptions, read_activities
    from mmweaver.weaver.front_door import Weaver

    assert asked.activities is not None
    activities = read_activities(asked.activities)
    given = {name: getattr(asked, name) for name in ("seconds", "subjects", "iq", "board")}
    given |= {"each": asked.per_class, "split_by": asked.split}
    given = {name: value for name, value in given.items() if value is not None}
    options = SetOptions(seed=asked.seed, strict=asked.strict, **given)
    weaver = Weaver(method=asked.method or "auto", radar=asked.radar_config())
    if not asked.room:
        raise InputError("which room? give --room DIR with rgb.png and depth.png")
    builder = SetBuilder(
        asked.out,
        activities,
        [weaver.open_room(place) for place in asked.room],
        weaver,
        options,
        command=_command(),
        activities_text=read_text(asked.activities),
    )
    if asked.dry_run:
        cost = builder.cost()
        return asked.report(asdict(cost), cost.summary(1))
    report = make_with_bar(builder, quiet=asked.quiet)
    return _print_report(asked, report, f"{len(activities)} labels x {options.each} sequences")


def _run_from_results(asked: "Options") -> int:
    """Combines result folders into one set."""
    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.datasets.build_set import read_activities
    from mmweaver.datasets.from_results import set_of_results

    assert asked.from_results is not None
    for name in ("room", "per_class", "seconds", "subjects", "method", "iq"):
        if getattr(asked, name) is not None:
            raise InputError(f"--from-results takes sequences as they are; leave out --{name.replace('_', '-')}")
    check_output_folder(asked.out, overwrite=False, inputs=[asked.from_results])
    report = set_of_results(
        asked.from_results,
        asked.out,
        split_by=asked.split,
        seed=asked.seed,
        command=_command(),
        activities=None if asked.activities is None else read_activities(asked.activities),
    )
    return _print_report(asked, report, f"{report['of']['order']['sequences']} sequences")


def _print_report(asked: "Options", report: dict[str, Any], what: str) -> int:
    from mmweaver.datasets.confounders import verdict_of

    return asked.report({"out": str(asked.out), "leaks": report}, f"{what} in {asked.out}; {verdict_of(report)}")


def make_with_bar(builder: "SetBuilder", *, quiet: bool) -> dict[str, Any]:
    """Generates the missing sequences of a set, with a progress bar.

    Args:
        builder: The set.
        quiet: Whether the bar is hidden.

    Returns:
        The leak report of the set.
    """
    from tqdm import tqdm

    from mmweaver.datasets.dataset_cost import check_for_space

    if (words := builder.ignored_descriptions) and not quiet:
        described = ", ".join(repr(one) for one in words)
        note = f"note: sentences describe different people ({described}); the sampled person does all activities"
        print(note, file=sys.stderr)
    builder.check_folder()
    if not builder.is_made:
        cost = builder.cost()
        # while the store is put together, its parts are there, too
        check_for_space(replace(cost, disk_bytes=2 * cost.disk_bytes), builder.out)
    with tqdm(unit="sequence", disable=quiet or None) as bar:

        def show(done: int, total: int) -> None:
            bar.total = total
            bar.update(done - bar.n)

        try:
            return builder.make(show)
        except KeyboardInterrupt:
            kept = f"{builder.finished} sequences are finished in {builder.out}; the same command makes the rest"
            raise KeyboardInterrupt(kept if builder.finished else "") from None


def _command() -> str:
    """The command line that generates the rest of the set."""
    return shlex.join(["mmweaver", *sys.argv[1:]]) if sys.argv[1:2] == ["dataset"] else "mmweaver dataset"
