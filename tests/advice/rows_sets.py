"""Advice about data sets, training, recognisers and what else takes long: up to where the work would begin."""

from tests.advice.harness import Row, add, drop, instead

SET = "dataset out --activities {activities} --dry-run"
TRAIN = "train weaver --data {walk} --out out"
ROOMS = "dataset out --layouts 1 --sequences 1 --dry-run"

ROWS = (
    Row(
        "is for labelled sets; give --activities, too",
        f"{ROOMS} --per-class 2",
        (
            instead(
                "give --activities",
                "--layouts 1 --sequences 1",
                "--activities {activities} --room {own_room}",
            ),
        ),
    ),
    Row(
        "is for data sets of rooms; leave it out",
        f"{SET} --room {{own_room}} --layouts 3",
        (instead("leave it out", "--layouts 3"),),
    ),
    Row(
        "--from-results takes sequences as they are",
        "dataset out --from-results {results} --per-class 2",
        (drop("--per-class"),),
    ),
    Row(
        "which room? give --room DIR",
        SET,
        (add("--room", "{own_room}"),),
    ),
    Row(
        "give what mmweaver generate --texts wrote",
        "dataset out --from-results {nothing}",
        (instead("give what mmweaver generate --texts wrote", "{nothing}", "{results}"),),
    ),
    Row(
        "is a sentence of no activity",
        "dataset out --from-results {results} --activities {jumping}",
        (
            drop("--activities"),
            instead("add it to one", "{jumping}", "{activities}"),
        ),
    ),
    # training: the options alone
    Row(
        "--rgb and --depth belong together",
        "train weaver --recordings {walk} --weights builtin --rgb {rgb} --out out",
        (add("--depth", "{depth}"),),
    ),
    Row(
        "--learning-rate must be above 0",
        f"{TRAIN} --learning-rate 0",
        (instead("above 0", "--learning-rate 0", "--learning-rate 0.001"),),
    ),
    Row("--save-every must be 0 or more seconds", f"{TRAIN} --save-every -1", (instead("0 or more", "-1", "0"),)),
    # others
)
