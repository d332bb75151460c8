"""Advice of `mmweaver generate`."""

from pathlib import Path

from tests.advice.harness import Row, add, drop, flag, instead

SHORT = "--frames 1 --no-pictures --out out"
DEMO = f"generate --demo {SHORT}"
PHOTO = "--rgb {rgb} --depth {depth} --camera {camera}"


BATCH = f"generate --demo --texts {{texts}} {SHORT}"
STREAM = f"generate --demo --stream --text 'a person waves' {SHORT}"


def _holds_something(name: str = "out/notes.txt") -> None:
    Path(name).parent.mkdir(parents=True, exist_ok=True)
    Path(name).write_text("mine")


def _a_stream() -> None:
    _holds_something("out/parts.jsonl")


ROWS = (
    Row(
        "--demo brings its own room",
        f"{DEMO} {PHOTO} --text 'a person waves'",
        (drop("--rgb", "--depth", "--camera"), drop("--demo")),
    ),
    Row(
        "which room? give --rgb and --depth",
        f"generate --text 'a person waves' {SHORT}",
        (flag("--demo"), add("--rgb", "{rgb}", "--depth", "{depth}", "--camera", "{camera}")),
    ),
    Row(
        "--rgb needs --depth too",
        f"generate --rgb {{rgb}} --camera {{camera}} --text 'a person waves' {SHORT}",
        (add("--depth", "{depth}"),),
    ),
    Row(
        "--depth needs --rgb too",
        f"generate --depth {{depth}} --camera {{camera}} --text 'a person waves' {SHORT}",
        (add("--rgb", "{rgb}"),),
    ),
    Row(
        "--room brings the whole room",
        f"generate --room {{views}} --depth {{depth}} --camera {{camera}} --text 'a person waves' {SHORT}",
        (drop("--depth", "--camera"),),
    ),
    Row(
        "--photo, --extra-views and --mesh-set are of a scan or mesh",
        f"generate --rgb {{rgb}} --depth {{depth}} --extra-views auto --text 'a person waves' {SHORT}",
        (instead("give --room", "--rgb {rgb} --depth {depth}", "--room {scan}"),),
    ),
    Row(
        "are no numbers of photos",
        f"generate --room {{scan}} --extra-views many --text 'a person waves' {SHORT}",
        (instead("write 60,120,180", "many", "60,120,180"), instead("or auto", "many", "auto")),
    ),
    Row(
        "what does the person do? give --text",
        f"generate {PHOTO} {SHORT}",
        (add("--text"), add("--motion", "{motion}", "--motion-set", "fps=30")),
    ),
    Row(
        "where to? give --out",
        f"generate {PHOTO} --text 'a person waves' --frames 1 --no-pictures",
        (add("--out", "out"),),
    ),
    Row("holds a stream already", STREAM, (instead("choose another --out", "out", "other"),), before=_a_stream),
    Row(
        "a stream needs a folder of its own",
        STREAM,
        (instead("choose another --out", "out", "other"),),
        before=_holds_something,
    ),
    Row(
        "--motion-model acts out one text",
        f"{DEMO} --motion-model {{model}} --text 'a person waves' --text 'a person jumps'",
        (instead("give --text once", "--text 'a person jumps'"),),
    ),
    Row(
        "--motion is a recorded motion",
        f"{DEMO} --motion {{clip}} --motion-model {{model}} --text 'a person waves'",
        (instead("give one of them", "--motion {clip}"), instead("give one of them", "--motion-model {model}")),
    ),
    Row(
        "--motion-model acts out a text; give --text",
        f"generate {PHOTO} {SHORT} --texts {{texts}} --motion-model {{model}}",
        (instead("give --text", "--texts {texts}", "--text 'a person waves'"),),
    ),
    Row(
        "--path is for a sentence",
        f"{DEMO} --motion {{clip}} --path '0,1.6 0.4,1.6' --text 'a person walks'",
        (
            instead("leave one of them out", "--path '0,1.6 0.4,1.6'"),
            instead("leave one of them out", "--motion {clip}"),
        ),
    ),
    Row(
        "--as-recorded moves nothing",
        f"{DEMO} --motion {{clip}} --as-recorded --at 0,2 --heading 0",
        (drop("--at", "--heading"), drop("--as-recorded")),
    ),
    Row(
        "--motion-set is about a recorded motion; give --motion too",
        f"{DEMO} --motion-set unit=cm --motion-set fps=30",
        (add("--motion", "{motion}"),),
    ),
    Row(
        "--radar-set belongs to a radar",
        "process {iq} --radar-set antennas=boost --no-pictures --out out",
        (add("--radar", "{radar}"),),
    ),
    Row(
        "--as-recorded is about a recorded motion; give --motion too",
        f"{DEMO} --as-recorded --text 'a person waves'",
        (add("--motion", "{clip}"),),
    ),
    Row(
        "holds no □; give a folder of mmweaver train",
        f"{DEMO} --weights {{nothing}}",
        (instead("or a weight file", "{nothing}", "{weights}"),),
    ),
    Row(
        "does not exist; give a .safetensors file",
        f"{DEMO} --weights absent.safetensors",
        (instead("give a .safetensors file", "absent.safetensors", "{weights}"),),
    ),
    # many sentences
    Row("--texts makes many sequences", f"{BATCH} --motion {{clip}}", (drop("--motion"), drop("--texts"))),
    Row(
        "--texts takes one --radar-pose",
        f"{BATCH} --radar-pose 0,0,0,0,0 --radar-pose 0.1,0,0,0,0",
        (instead("takes one --radar-pose", "--radar-pose 0.1,0,0,0,0"),),
    ),
    Row(
        "--texts makes sequences of one person each",
        f"{BATCH} --at 0,2 --at 0.5,2",
        (instead("give --at once", "--at 0.5,2"),),
    ),
    Row(
        "--per-class must be 1 to", f"{BATCH} --per-class 100000", (instead("--per-class must be 1 to", "100000", "1"),)
    ),
    Row(
        "an empty room is no sequence of a person",
        f"generate --demo --texts {{with_nobody}} {SHORT}",
        (instead("with --text", "--texts {with_nobody}", "--text nobody"),),
    ),
    Row(
        "holds something else; choose another --out",
        f"{BATCH}",
        (instead("choose another --out", "out", "other"), flag("--overwrite")),
        before=lambda: _holds_something("out/0000/meta.json"),
    ),
    Row("--per-class is for many sequences", f"{DEMO} --per-class 2", (add("--texts", "{texts}"),)),
    # a stream
    Row("--stream takes sentences", f"{STREAM} --path '0,3 0,1.5'", (drop("--path"),)),
    Row("--stream is of one person", f"{STREAM} --at 0,2 --at 0.5,2", (instead("give --at once", "--at 0.5,2"),)),
    Row(
        "□ is an empty place, a sequence of its own",
        "generate --demo --no-pictures --out out --stream --text 'a person waves' --text nobody",
        (instead("generate --text nobody, alone", "out --stream --text 'a person waves'", "other"),),
    ),
    Row(
        "--stream needs sentences",
        f"generate --demo --stream {SHORT}",
        (add("--text", "a person waves"), add("--texts", "{texts}"), add("--texts", "-")),
    ),
    Row(
        "--method-set has bounces=1 or 2 and clutter=all or resolved",
        f"{DEMO} --text 'a person waves' --frames 1 --method-set bounces=3",
        (
            instead("bounces=1 or 2", "bounces=3", "bounces=1"),
            instead("clutter=all or resolved", "bounces=3", "clutter=resolved"),
        ),
    ),
)
