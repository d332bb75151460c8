"""mmweaver generate: photo and sentence in, radar signal out."""

import argparse
import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.cli.arguments import add_layout_options, add_output_options, add_points_option, number, place, told, whole
from mmweaver.cli.motion_options import (
    add_motion_options,
    check_motion_options,
    motion_of_model,
    placing_options,
    read_own_motion,
)
from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from mmweaver.core.records import RadarCube
    from mmweaver.generate import Room, Weaver

DEMO_TEXT = "a person walks towards the radar, then waves with the left hand"
DEMO_OUT = "demo"
DEFAULT_RADAR = "awr1843"
NUM_STAGES = 9
EXAMPLES = """examples:
  mmweaver generate --demo
  mmweaver generate --rgb rgb.png --depth depth.png --camera camera.json \\
      --text "a person walks towards the radar, then waves with the left hand" --out walk/ --seed 0
  mmweaver generate --rgb rgb.png --depth depth.npy --text "a person sits down and drinks" \\
      --frames 40 --radar mmmesh --out drink/ --bin
  mmweaver generate --demo --method physics --out traced/
  mmweaver generate --demo --texts sentences.txt --repeat 20 --no-pictures --out set/       # one sentence a line
  mmweaver process empty.bin --radar profile.cfg --out empty/       # your room with nobody in it, a few seconds
  mmweaver generate --rgb rgb.png --depth depth.png --empty-room empty/ --text "a person walks" --out walk/
  mmweaver generate --demo --motion walk.bvh --motion-unit cm --at 0.2,2.5 --heading 0 --out walk/
  mmweaver generate --demo --motion-model small --text "a person waves with the left hand" --out wave/
"""


def add_verb(verbs: Any) -> None:
    """Declares the verb and its options."""
    parser = verbs.add_parser(
        "generate",
        help="make the signal of a person in the room of a photo",
        epilog=EXAMPLES,
        description="Makes the signal that a radar at the camera would have recorded of a person doing what the text "
        "says, in the room that the photo shows.",
    )
    _add_room_options(parser)
    person = parser.add_argument_group("the person")
    person.add_argument(
        "--text",
        action="append",
        help=f"what the person does (with --demo: {DEMO_TEXT!r}); once more for each further person",
    )
    person.add_argument(
        "--texts", type=Path, metavar="FILE",
        help="many sequences instead, one a line of this file, each in a folder of its own under --out; the room is"
        " read once, and what is there already stays",
    )  # fmt: skip
    person.add_argument(
        "--repeat",
        type=whole,
        default=1,
        metavar="N",
        help="with --texts: N of each, with seeds of their own",
    )
    person.add_argument(
        "--at",
        type=place,
        action="append",
        metavar="X,Y",
        help="where the person starts: metres right of and ahead of the radar (default: chosen); of several people"
        " the first --at is the first one's",
    )
    add_motion_options(person)
    radar = parser.add_argument_group("the radar")
    radar.add_argument(
        "--radar", metavar="NAME|FILE",
        help="preset, TI .cfg or radar.json (default awr1843, or what --empty-room was recorded with)",
    )  # fmt: skip
    radar.add_argument("--frames", type=whole, default=20, help="how many frames (default 20)")
    radar.add_argument("--fps", type=number, help="frames a second (default: the radar's own, 10 for awr1843)")
    radar.add_argument(
        "--method",
        default="auto",
        help="how the signal is made: weaver, the trained network; physics; or auto (default), weaver but for --bin,"
        " --points firmware, several people and chirps of more than 40 ms a frame, which physics makes",
    )
    radar.add_argument(
        "--weights", metavar="FILE|DIR|HUB", help="the network's weights, of mmweaver train; or their name on the Hub"
    )
    add_points_option(radar)
    radar.add_argument("--seed", type=whole, default=0, help="the same seed gives the same bits (default 0)")
    output = parser.add_argument_group("output")
    output.add_argument("--out", type=Path, metavar="DIR", help="folder for the results")
    output.add_argument(
        "--bin", action="store_true", help="also write adc_data.bin, as a DCA1000 would; physics makes it"
    )
    output.add_argument("--no-pictures", action="store_true", help="leave out preview.png and preview.gif")
    add_layout_options(output)
    add_output_options(output)
    parser.set_defaults(run=run)


def _add_room_options(parser: argparse.ArgumentParser) -> None:
    room = parser.add_argument_group("the room")
    room.add_argument("--rgb", type=Path, metavar="PNG", help="colour picture")
    room.add_argument(
        "--depth",
        type=Path,
        metavar="FILE",
        help="its depth: 16-bit PNG (mm, or camera.json's unit), .npy or float TIFF in metres",
    )
    room.add_argument(
        "--depth-model", metavar="DIR|HUB", help="where there is no --depth: a metric depth model that estimates it"
    )
    room.add_argument(
        "--camera",
        type=Path,
        metavar="JSON",
        help="fx, fy, cx, cy in pixels (default: a RealSense D455's field of view)",
    )
    room.add_argument(
        "--classes", type=Path, metavar="PNG", help="what each pixel shows (COCO-Stuff's numbers): materials follow"
    )
    room.add_argument(
        "--segmenter",
        metavar="builtin|DIR|HUB",
        help="instead: what finds it: builtin, or a SegFormer, MaskFormer, Mask2Former ... by folder or Hub name",
    )
    room.add_argument("--sam", metavar="DIR|HUB", help="a SAM model whose masks sharpen the segmenter's edges")
    room.add_argument(
        "--landmark", type=told, action="append", default=[], metavar="KIND=X,Y",
        help="where a door, window, table, counter or bed is, if the photo does not show it well: metres right of and"
        " ahead of the radar, for example door=0.9,2.8",
    )  # fmt: skip
    room.add_argument(
        "--capture", type=Path, metavar="DIR",
        help="instead: a capture folder of mmwave-capture-std; its RealSense's photo and depth",
    )  # fmt: skip
    room.add_argument(
        "--empty-room", type=Path, metavar="DIR|NPZ",
        help="a recording of this room by your radar with nobody there, a folder of mmweaver process or a capture"
        " folder: what rests is taken from it, phases and all, and the person is added",
    )  # fmt: skip
    room.add_argument("--photo", type=whole, default=0, metavar="N", help="which photo of the capture (default 0)")
    room.add_argument("--demo", action="store_true", help=f"the bundled sample room (and --out {DEMO_OUT})")


def run(arguments: argparse.Namespace) -> int:
    """Checks all that is cheap, then makes the signal and writes it. Raises InputError."""
    text, out = _check_inputs(arguments)
    check_motion_options(arguments)
    if arguments.texts is not None:
        return _run_many(arguments, out)

    from mmweaver.cli.progress import StageBar
    from mmweaver.cli.summary import print_summary
    from mmweaver.core.atomic_files import check_output_folder

    check_output_folder(out, overwrite=arguments.overwrite)
    with StageBar(NUM_STAGES, quiet=arguments.quiet) as bar:
        from mmweaver.generate import check_request

        recording = _recording(arguments)
        weaver = _weaver(arguments, recording, bar)
        request = _request(arguments) | {"at": _places(arguments)}
        texts = text if text is None or len(text) > 1 else text[0]
        period_s = 1 / arguments.fps if arguments.fps else weaver.radar.frame_period_s
        seconds = arguments.frames * period_s
        only = texts if isinstance(texts, str) else None
        if arguments.motion_model is not None and only is None and text is not None:
            raise InputError("--motion-model acts out one text; give --text once")
        motion = read_own_motion(arguments) or motion_of_model(arguments, only, seconds)
        check_request(weaver.radar, text=texts, motion=motion, **request)
        request |= placing_options(arguments)
        result = weaver.generate(_read_room(weaver, arguments, recording), texts, motion=motion, **request)
        meta = result.save(
            out, overwrite=arguments.overwrite, adc_data_bin=arguments.bin, iq_order=arguments.iq_order or "iq",
            pictures=not arguments.no_pictures,
        )  # fmt: skip
    print_summary(out, meta, as_json=arguments.json, quiet=arguments.quiet)
    return 0


def _run_many(arguments: argparse.Namespace, out: Path) -> int:
    """Many sequences in one room."""
    from mmweaver.cli.batch import asked_of, check_texts, make_many, told

    asked, request = asked_of(arguments, out), _request(arguments)
    recording = _recording(arguments)
    weaver = _weaver(arguments, recording)
    config = check_texts(weaver, asked, request, arguments.texts)
    summary = make_many(weaver, _read_room(weaver, arguments, recording), asked, request, config, arguments)
    if arguments.json:
        print(json.dumps(summary, indent=2, ensure_ascii=False))
    elif not arguments.quiet:
        print(told(summary))
    return 0


def _weaver(
    arguments: argparse.Namespace, recording: "RadarCube | None", listener: "Callable[[str], object] | None" = None
) -> "Weaver":
    from mmweaver.formats.radar_file import load_firmware, load_radar
    from mmweaver.generate import Weaver

    radar = recording.config if recording and not arguments.radar else load_radar(arguments.radar or DEFAULT_RADAR)
    if arguments.tx_order is not None:
        radar = replace(radar, tx_order=arguments.tx_order)
    firmware = load_firmware(arguments.radar or DEFAULT_RADAR) if arguments.points == "firmware" else None
    return Weaver(
        method=arguments.method, radar=radar, listener=listener, points=arguments.points, firmware=firmware,
        weights=arguments.weights,
    )  # fmt: skip


def _request(arguments: argparse.Namespace) -> dict[str, Any]:
    return {
        "frames": arguments.frames, "fps": arguments.fps, "seed": arguments.seed, "keep_adc": arguments.bin,
    }  # fmt: skip


def _places(arguments: argparse.Namespace) -> Any:
    """One place of one person, or a list of several people's."""
    at = arguments.at
    return at[0] if at is not None and len(at) == 1 and len(arguments.text or [""]) == 1 else at


def _check_inputs(arguments: argparse.Namespace) -> tuple[list[str] | None, Path]:
    """The texts and the output folder, once it is clear which room is meant."""
    pictures = (
        arguments.rgb, arguments.depth, arguments.camera, arguments.capture, arguments.depth_model, arguments.classes,
        arguments.segmenter, arguments.sam,
    )  # fmt: skip
    if arguments.demo:
        if any(picture is not None for picture in pictures):
            raise InputError(
                "--demo brings its own room; leave out --rgb, --depth, --camera and all else that tells of a room, or"
                " leave out --demo"
            )
        is_told = arguments.text is not None or arguments.motion is not None or arguments.texts is not None
        text = arguments.text if is_told else [DEMO_TEXT]
        return text, arguments.out or Path(DEMO_OUT)
    if arguments.capture is not None:
        if any(given is not None for given in (arguments.depth, arguments.camera, arguments.depth_model)):
            raise InputError("--capture brings its own depth and camera; leave out --depth, --camera and --depth-model")
        return _text_and_out(arguments)
    if arguments.rgb is None and arguments.depth is None:
        raise InputError("which room? give --rgb and --depth, or try --demo")
    if arguments.depth is not None and arguments.depth_model is not None:
        raise InputError("--depth-model is for a photo without depth; leave out one of --depth and --depth-model")
    if arguments.depth is None and arguments.depth_model is None:
        raise InputError(
            "--rgb needs --depth too, for the room is built from the distance of each pixel; a metric depth model can"
            " estimate it: --depth-model DIR, or a Hub name such as"
            " depth-anything/Depth-Anything-V2-Metric-Indoor-Small-hf"
        )
    if arguments.rgb is None:
        raise InputError("--depth needs --rgb too: the colour picture of the same view")
    return _text_and_out(arguments)


def _text_and_out(arguments: argparse.Namespace) -> tuple[list[str] | None, Path]:
    if arguments.text is None and arguments.motion is None and arguments.texts is None:
        raise InputError(
            "what does the person do? give --text, for example --text 'a person walks to the left', or --motion"
        )
    if arguments.out is None:
        raise InputError("where to? give --out, a folder for the results")
    return arguments.text, arguments.out


def _read_room(weaver: "Weaver", arguments: argparse.Namespace, recording: "RadarCube | None") -> "Room":
    room = _seen_room(weaver, arguments)
    room = room.with_landmarks(*arguments.landmark) if arguments.landmark else room
    return room if recording is None else room.with_empty_recording(recording, came_from=arguments.empty_room)


def _recording(arguments: argparse.Namespace) -> "RadarCube | None":
    """The recording of the empty room, if one is given. Raises InputError for what physics would have to take."""
    if arguments.empty_room is None:
        return None
    if arguments.method == "physics" or arguments.bin or arguments.points == "firmware":
        raise InputError(
            "--empty-room is for the network, which has no raw samples; leave it out, or --method physics, --bin and"
            " --points firmware"
        )
    from mmweaver.recordings.read_recording import read_recording

    return read_recording(arguments.empty_room).cube


def _seen_room(weaver: "Weaver", arguments: argparse.Namespace) -> "Room":
    if arguments.demo:
        return weaver.sample_room()
    seen = {"classes": arguments.classes, "segmenter": arguments.segmenter, "sam": arguments.sam}
    if arguments.capture is not None:
        return weaver.read_capture(arguments.capture, photo=arguments.photo, rgb=arguments.rgb, **seen)
    return weaver.read_room(arguments.rgb, arguments.depth, arguments.camera, depth_model=arguments.depth_model, **seen)
