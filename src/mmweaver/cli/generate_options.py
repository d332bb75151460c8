"""The options of `mmweaver generate`, in groups: input, motion, radar, output, advanced."""

import argparse
from pathlib import Path

from mmweaver.cli.arguments import (
    Options,
    Rare,
    add_board_option,
    add_board_options,
    add_layout_options,
    add_output_options,
    add_points_option,
    add_range_options,
    landmark,
    number,
    place,
    radar_pose,
    source,
    triple,
    whole,
)
from mmweaver.cli.motion_options import add_motion_options

DEMO_TEXT = "a person walks towards the radar, then waves with the left hand"
DEMO_OUT = "demo"
USAGE = """mmweaver generate --demo
       mmweaver generate --rgb PNG --depth FILE --text TEXT --out DIR [options]
       mmweaver generate --config request.toml --out DIR [options]"""


def add_generate_options(parser: argparse.ArgumentParser) -> None:
    """Declares all of them."""
    _add_input_options(parser.add_argument_group("input"))
    motion = parser.add_argument_group("motion")
    _add_sentence_options(motion)
    add_motion_options(motion)
    _add_radar_options(parser.add_argument_group("radar"))
    _add_result_options(parser.add_argument_group("output"))
    advanced = parser.add_argument_group("advanced")
    advanced.add_argument(
        "--method", default="auto",
        help="which paths make the signal: weaver, those of the trained network (default, also called auto), or"
        " physics, those of the ray tracer, at about five times the cost",
    )  # fmt: skip
    advanced.add_argument(
        "--bounces", type=int, choices=(1, 2),
        help=Rare("2 (default): also paths over body and room, room and room, body-radar-body; or 1"),
    )  # fmt: skip
    advanced.add_argument(
        "--clutter", choices=("all", "resolved"),
        help=Rare("with static clutter that photo and mesh do not resolve (default), or without"),
    )  # fmt: skip
    advanced.add_argument(
        "--weights", type=source, metavar="FILE|DIR|HUB",
        help="the network's weights: a file or folder of mmweaver train, or a name on the Hub",
    )  # fmt: skip
    add_layout_options(advanced, rare=True)


def _add_input_options(room: Options) -> None:
    room.add_argument("--demo", action="store_true", help=f"the bundled sample room (and --out {DEMO_OUT})")
    room.add_argument("--rgb", type=Path, metavar="PNG", help="colour picture of the room")
    room.add_argument(
        "--depth", type=Path, metavar="FILE",
        help="its depth: 16-bit PNG (mm, or camera.json's unit), .npy or float TIFF in metres",
    )  # fmt: skip
    room.add_argument(
        "--camera", type=Path, metavar="JSON", help="fx, fy, cx, cy in pixels (default: a RealSense D455's)"
    )
    room.add_argument(
        "--background", type=Path, metavar="DIR|NPZ",
        help="a recording of this room by your radar with nobody present, a folder of mmweaver process or a capture"
        " folder: its static clutter is used as it is, and the person is added",
    )  # fmt: skip
    room.add_argument("--empty-room", type=Path, dest="background", default=argparse.SUPPRESS, help=argparse.SUPPRESS)
    room.add_argument(
        "--depth-model", type=source, metavar="auto|DIR|HUB",
        help=Rare("where there is no --depth: a metric depth model that estimates it (auto: downloaded once)"),
    )  # fmt: skip
    room.add_argument(
        "--classes", type=Path, metavar="PNG",
        help=Rare("what each pixel shows (COCO-Stuff's numbers): materials follow from it"),
    )  # fmt: skip
    room.add_argument(
        "--segmenter", type=source, metavar="builtin|DIR|HUB",
        help=Rare("a model that finds the classes: builtin, or a SegFormer, MaskFormer, Mask2Former ... by folder or"
        " Hub name"),
    )  # fmt: skip
    room.add_argument(
        "--sam", type=source, metavar="DIR|HUB", help=Rare("a SAM model whose masks sharpen the segmenter's edges")
    )
    room.add_argument(
        "--landmark", type=landmark, action="append", default=[], metavar="KIND=X,Y",
        help=Rare("where a door, window, table, counter or bed is, if the photo does not show it well: metres right of"
        " and ahead of the radar, for example door=0.9,2.8"),
    )  # fmt: skip
    room.add_argument(
        "--capture", type=Path, metavar="DIR|BAG",
        help=Rare(
            "instead of --rgb: a folder with photos and depth: mmwave-capture-std (a RealSense), Stray Scanner,"
            " Record3D, Polycam (raw data), ScanNet or TUM RGB-D; or a ROS bag (RealSense)"
        ),
    )  # fmt: skip
    room.add_argument(
        "--photo", type=whole, default=0, metavar="N", help=Rare("which photo of the capture (default 0)")
    )
    room.add_argument(
        "--further-photos", metavar="N,N..|auto",
        help=Rare("further photos of a scan, joined to --photo by its poses, so that walls beside and behind the radar"
        " are known: numbers, or auto for up to five that show the most"),
    )  # fmt: skip
    room.add_argument(
        "--views", type=Path, metavar="JSON",
        help="instead of --rgb: several photos with depth, and roughly where each was taken (docs/photos.md)",
    )  # fmt: skip
    room.add_argument(
        "--mesh", type=Path, metavar="FILE",
        help=Rare("instead of --rgb: the room as a scan or model (.glb, .ply, .obj), with more than a photo shows"),
    )  # fmt: skip
    room.add_argument(
        "--mesh-eye", type=triple, metavar="X,Y,Z",
        help=Rare("the radar's place in the mesh's own axes and unit (default: near a wall, with the room ahead)"),
    )  # fmt: skip
    room.add_argument(
        "--mesh-look", type=number, metavar="DEG",
        help=Rare("where it looks: degrees from the mesh's x axis, counterclockwise from above (default: most room)"),
    )  # fmt: skip
    room.add_argument("--mesh-unit", metavar="NAME", help=Rare("m, cm, mm, inch or foot (default: what fits a room)"))
    room.add_argument("--mesh-up", metavar="AXIS", help=Rare("y or z (default: y for .glb, else by the floor)"))
    room.add_argument(
        "--mesh-materials", type=Path, metavar="JSON",
        help=Rare('what the mesh\'s names are: {"Material.003": "couch", "pane": "glass"}'),
    )  # fmt: skip


def _add_sentence_options(person: Options) -> None:
    person.add_argument(
        "--text", action="append",
        help=f"what the person does (with --demo: {DEMO_TEXT!r}); once more for each further person",
    )  # fmt: skip
    person.add_argument(
        "--texts", type=Path, metavar="FILE",
        help="many sequences, one sentence a line of this file, each in its own folder under --out; the room is"
        " read once, and finished sequences are kept",
    )  # fmt: skip
    person.add_argument(
        "--stream", action="store_true",
        help="one recording of one person who does what every --text, line of --texts or of standard input (--texts -)"
        " says, without a break, written part by part for as long as sentences come",
    )  # fmt: skip
    person.add_argument(
        "--repeat", type=whole, default=1, metavar="N", help=Rare("with --texts: N of each, each with its own seed")
    )
    person.add_argument(
        "--draws", choices=("matched", "free"), default="matched",
        help=Rare("with --texts: the same places, headings, people and lengths for all sentences (matched, default), or"
        " each sentence by itself (free)"),
    )  # fmt: skip
    person.add_argument(
        "--store", action="store_true",
        help=Rare("with --texts: one labelled set (the store of mmweaver dataset --activities) instead of folders; a"
        " sentence is a label"),
    )  # fmt: skip
    person.add_argument(
        "--iq", choices=("float16", "float32", "none"),
        help=Rare("with --store: how signals are stored (default float16); none: what they are made from"),
    )  # fmt: skip
    person.add_argument(
        "--at", type=place, action="append", metavar="X,Y",
        help="where the person starts: metres right of and ahead of the radar (default: chosen); of several people"
        " the first --at is the first one's",
    )  # fmt: skip


def _add_radar_options(radar: Options) -> None:
    radar.add_argument(
        "--radar", type=source, metavar="NAME|FILE",
        help="preset, TI .cfg or radar.json (default awr1843, or what --background was recorded with)",
    )  # fmt: skip
    radar.add_argument(
        "--radar-pose", type=radar_pose, action="append", metavar="X,Y,Z,YAW,PITCH[,ROLL]",
        help="where the radar stands, in metres right of, ahead of and above the camera, and degrees to which it is"
        " turned to the right, up, and about its boresight (default: at the camera, level); once more for each further"
        " radar, which records the same scene at the same time (docs/several_radars.md)",
    )  # fmt: skip
    add_range_options(radar)
    add_board_option(radar)
    add_board_options(radar, rare=True)
    length = radar.add_mutually_exclusive_group()
    length.add_argument(
        "--frames", type=whole, help="number of frames (default: as long as the sentence needs, at least 2 s)"
    )
    length.add_argument("--seconds", type=number, metavar="S", help="instead of --frames: how long")
    radar.add_argument("--fps", type=number, help="frames per second (default: the radar's own, 10 for awr1843)")
    add_points_option(radar)


def _add_result_options(output: Options) -> None:
    output.add_argument("--out", type=Path, metavar="DIR", help="folder for the results")
    output.add_argument("--seed", type=whole, default=0, help="the same seed gives the same bits (default 0)")
    output.add_argument("--bin", action="store_true", help="also write adc_data.bin, raw samples as a DCA1000 does")
    output.add_argument(
        "--html", type=Path, metavar="FILE", help=Rare("also write one HTML file that plays the result in any browser")
    )
    output.add_argument("--no-pictures", action="store_true", help="leave out preview.png and preview.gif")
    add_output_options(output)
