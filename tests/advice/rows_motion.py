"""Advice where a sentence or a recorded motion does not fit its room or its time."""

from tests.advice.harness import Row, add, both, drop, first, instead, plus
from tests.advice.made_inputs import use_room_without

SHORT = "--no-pictures --out out"
DEMO = f"generate --demo {SHORT}"
ONE = f"{DEMO} --frames 1"

ROWS = (
    *(
        Row(
            "or a class mask (--classes),",
            f"{ONE} --missing refuse --text 'a person {text}'",
            (add("--landmark", f"{kind}=0.3,2.3"),),
        )
        for kind, text in (
            ("sink", "walks to the sink"),
            ("lamp", "points at the lamp"),
            ("bin", "stands at the bin"),
        )
    ),
    Row(
        " put one there with --furnish □=X,Y,",
        f"{ONE} --missing refuse --text 'a person walks to the wardrobe'",
        (add("--furnish", "wardrobe=0.9,2.6"),),
    ),
    Row(
        "room stand for it with --missing stand-in",
        f"{ONE} --missing refuse --text 'a person sits on the bed'",
        (
            instead("with --missing stand-in", "refuse", "stand-in"),
            add("--furnish", "bed=-0.6,2.2"),
        ),
    ),
    Row(
        "or leave out --strict",
        f"{ONE} --strict --text 'a person walks 9 m to the left'",
        (
            drop("--strict"),
            instead("word it otherwise", "'a person walks 9 m to the left'", "'a person stands'"),
        ),
    ),
    Row(
        "try --range □,□",
        f"{ONE} --range 0.7,1.0 --text 'a person waves'",
        (add("--range"), both(drop("--range"), add("--radar"))),
    ),
    Row(
        "take another radar (--radar) or a photo with more floor",
        f"{ONE} --range 0.7,1.0 --text 'a person waves'",
        (
            instead("keep more range bins", "0.7,1.0", "0.7,3.5"),
            plus("another radar", "--range", "0.5,3.5", "--radar", "iwr6843isk"),
        ),
    ),
    Row(
        "another direction (--heading), or keep more range bins (--range)",
        f"{DEMO} --frames 20 --range 1.5,2 --text 'a person sits down on the chair, then walks to the wall'",
        (add("--heading", "90"), instead("or keep more range bins (--range)", "1.5,2", "1.5,3")),
    ),
    Row(
        "□: no wall was found in the photo",
        f"{ONE} --text 'a person stands in front of the wall'",
        (
            add("--landmark", "wall=0.3,2.3"),
            instead("or say another place", "'a person stands in front of the wall'", "'a person stands'"),
        ),
        before=lambda: use_room_without("wall"),
    ),
    Row(
        "finds no place next to the others",
        f"{DEMO} --frames 20 --text 'a person walks' --text 'a person stands' --at 0,2 --at 0.1,2",
        (
            instead("fewer people", "--text 'a person stands' --at 0,2 --at 0.1,2"),
            instead("or other places (--at for each)", "0.1,2", "0.7,2"),
        ),
    ),
    Row(
        "listed by 'mmweaver motions'",
        f"{ONE} --text 'a person photosynthesises'",
        (first("mmweaver motions", instead("known are", "'a person photosynthesises'", "'a person waves'")),),
    ),
    Row(
        "--seconds or --frames, or leave them out",
        f"{DEMO} --text 'a person sits down' --frames 1",
        (
            instead("more --seconds", "--frames 1", "--seconds 6"),
            instead("or --frames", "--frames 1", "--frames 60"),
            drop("--frames"),
        ),
    ),
    Row(
        "or none and ask for more --seconds",
        f"{DEMO} --text 'a person claps and bows, repeating it 40 times'",
        (
            instead(
                "say fewer",
                "'a person claps and bows, repeating it 40 times'",
                "'a person claps and bows, repeating it 4 times'",
            ),
            instead(
                "more --seconds",
                "'a person claps and bows, repeating it 40 times'",
                "'a person claps and bows' --seconds 40",
            ),
        ),
    ),
    Row(
        "say it of one and give --text once for each",
        f"{ONE} --text 'two people wave'",
        (instead("give --text once for each", "'two people wave'", "'a person waves' --text 'a person waves'"),),
    ),
    Row(
        "say so, or leave out --path",
        f"{ONE} --text 'a person waves' --path '0,1.6 0.4,1.6'",
        (drop("--path"), instead("walks or runs; say so", "'a person waves'", "'a person walks'")),
    ),
    Row(
        "s are too short for the path",
        f"{DEMO} --text 'a person walks' --path '-0.2,1.6 0.3,1.7 -0.2,1.8' --frames 2",
        (
            instead("more --seconds", "--frames 2", "--seconds 8"),
            instead("or --frames", "--frames 2", "--frames 80"),
            instead("a shorter path", "'-0.2,1.6 0.3,1.7 -0.2,1.8'", "'0,1.6 0.4,1.6'"),
        ),
    ),
    # recorded motions
    Row(
        "states no frame rate; give --motion-set fps=",
        f"{ONE} --motion {{motion}}",
        (plus("HumanML3D and MotionGPT: 20", "--motion-set", "fps=20"),),
    ),
    Row(
        "frames per second, not",
        f"{ONE} --motion {{motion}} --motion-set fps=0",
        (plus("--motion-set fps=", "--motion-set", "fps=30"),),
    ),
    Row(
        "is a person of",
        f"{ONE} --motion {{giant}} --motion-set fps=30",
        (plus("--motion-set unit=", "--motion-set", "unit=0.1"),),
    ),
    Row(
        "the upward axis cannot be estimated",
        f"{ONE} --motion {{leaning}} --motion-set fps=30",
        (plus("--motion-set up=", "--motion-set", "up=y"), plus("or up=z", "--motion-set", "up=z")),
    ),
    Row(
        "so it cannot start at",
        f"{ONE} --motion {{motion}} --motion-set fps=30 --motion-set start=50",
        (plus("--motion-set start=", "--motion-set", "start=0.1"),),
    ),
    Row(
        "then it sets the length, or give a longer motion",
        f"{DEMO} --motion {{motion}} --motion-set fps=30 --seconds 60",
        (drop("--seconds"),),
    ),
    Row(
        "holds a single motion, so there is no clip □; leave out --motion-set clip=",
        f"{ONE} --motion {{motion}} --motion-set fps=30 --motion-set clip=b",
        (instead("leave out --motion-set clip=NAME", "--motion-set clip=b"),),
    ),
    Row(
        "motions; choose one, for example --motion-set clip=",
        f"{ONE} --motion {{several}} --motion-set fps=30",
        (plus("for example --motion-set clip=", "--motion-set", "clip=walk"),),
    ),
    Row(
        "another --motion-set start=S, --at or --heading",
        f"{DEMO} --motion {{far}} --motion-set fps=30 --motion-set unit=m --motion-set up=y",
        (add("--frames", "2"), plus("or --as-recorded", "--as-recorded")),
    ),
    Row(
        "take a radar with a longer window (--radar)",
        f"{ONE} --motion {{motion}} --motion-set fps=30 --range 0.7,1.0",
        (plus("or --as-recorded", "--as-recorded"),),
    ),
)
