"""mmweaver motions: what a sentence may ask for, with an example of each."""

import json

from mmweaver.cli.arguments import General
from mmweaver.core.options import option, options

EXAMPLES = """examples:
  mmweaver motions
  mmweaver motions --json
"""


@options
class Options(General):
    """Lists every activity that a sentence may name, with an example and its natural time."""

    json: bool = option("print them for machines", default=False)


def run(asked: Options) -> int:
    """Prints the table of activities on stdout."""
    from mmweaver.motion.language.activities import BY_KEY
    from mmweaver.motion.register_activity import load_activity_plugins

    load_activity_plugins()
    body, hands = ([one for one in BY_KEY.values() if one.hands == is_hands] for is_hands in (False, True))
    if asked.json:
        rows = [
            {
                "activity": activity.key,
                "name": activity.name,
                "example": activity.example,
                "part": "hands" if activity.hands else "body",
                "shortest_s": activity.least_s,
                "natural_s": activity.natural_s,
                "can_be_counted": activity.counted_s is not None,
            }
            for activity in (*body, *hands)
        ]
        print(json.dumps(rows, indent=2))
        return 0
    for title, activities in (("the body", body), ("hands and head, over any of these", hands)):
        print(f"{title}:")
        for activity in activities:
            print(f"  {activity.name:24s} {activity.natural_s:3.1f} s   {activity.example}")
    print("joined by 'and', 'then', 'while', with sides, directions, speeds and counts: see docs/motion.md")
    return 0
