"""Advice about data sets, training, recognisers and what else takes long: up to where the work would begin."""

from tests.advice.harness import Row, add, drop, first, instead

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
    Row("what to train on? give --data", "train weaver --out out", (add("--data", "{walk}"),)),
    Row(
        "--recordings fine-tunes existing weights",
        "train weaver --recordings {walk} --out out",
        (add("--weights", "builtin"),),
    ),
    Row(
        "--encoder is for recipe weaver on --data",
        "train weaver --recordings {walk} --weights builtin --encoder none --out out",
        (drop("--encoder"),),
    ),
    Row(
        "--rgb, --depth and --camera are the photo of --recordings",
        f"{TRAIN} --rgb {{rgb}} --depth {{depth}}",
        (instead("are the photo of --recordings", "--rgb {rgb} --depth {depth}"),),
    ),
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
    Row(
        "train pose needs a task",
        "train pose --out model/",
        (first("mmweaver train pose", lambda *_: [], **{"TASK.toml": "{task}"}),),
    ),
    Row("a task and --sequences are for recipe pose", f"{TRAIN} --sequences 4", (drop("--sequences"),)),
    Row(
        "recipe pose is trained on the sentences of its task",
        "train pose {task} --data {walk} --out out",
        (drop("--data"),),
    ),
    Row(
        "--recordings is for recipe weaver; recipe",
        "train activity --recordings {walk} --weights builtin --out out",
        (instead("is trained on --data", "--recordings {walk} --weights builtin", "--data {walk}"),),
    ),
    # others
)
