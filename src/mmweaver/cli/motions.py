"""mmweaver motions: what a sentence may ask for, with an example of each."""

from typing import Any

from mmweaver.cli.option_groups import Printed
from mmweaver.core.options import options

EXAMPLES = """examples:
  mmweaver motions
  mmweaver motions --json
"""


@options
class Options(Printed):
    """Lists every activity that a sentence may name, with an example and its natural time."""


def run(asked: Options) -> int:
    """Prints the table of activities on stdout."""
    from mmweaver.motion.language.activities import BY_KEY
    from mmweaver.motion.register_activity import load_activity_plugins

    load_activity_plugins()
    activities = sorted(BY_KEY.values(), key=lambda one: one.hands)
    rows: list[dict[str, Any]] = [
        {
            "activity": one.key,
            "name": one.name,
            "example": one.example,
            "part": "hands" if one.hands else "body",
            "shortest_s": one.least_s,
            "natural_s": one.natural_s,
            "can_be_counted": one.counted_s is not None,
        }
        for one in activities
    ]
    lines: dict[str, list[str]] = {"body": [], "hands": []}
    for row in rows:
        lines[row["part"]].append(f"  {row['name']:24s} {row['natural_s']:3.1f} s   {row['example']}")
    return asked.report(
        rows,
        "the body:",
        *lines["body"],
        "hands and head, over any of these:",
        *lines["hands"],
        "joined by 'and', 'then', 'while', with sides, directions, speeds and counts: see docs/motion.md",
    )
