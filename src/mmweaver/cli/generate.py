"""mmweaver generate: photo and sentence in, radar signal out."""

import argparse
import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.cli.arguments import radar_of
from mmweaver.cli.config_file import REQUEST_FILE, request_toml
from mmweaver.cli.generate_options import (
    DEMO_OUT,
    DEMO_TEXT,
    USAGE,
    add_generate_options,
)
from mmweaver.cli.motion_options import (
    check_motion_options,
    motion_of_model,
    placing_options,
    read_own_motion,
)
from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from mmweaver.core.radar_config import RadarConfig
    from mmweaver.core.records import RadarCube
    from mmweaver.generate import Weaver
    from mmweaver.generation import Room
    from mmweaver.motion.mocap.clip import MotionClip

DEFAULT_RADAR = "awr1843"
NUM_STAGES = 9
EXAMPLES = """examples:
  mmweaver generate --demo
  mmweaver generate --rgb rgb.png --depth depth.png --camera camera.json \\
      --text "a person walks towards the radar, then waves with the left hand" --out walk/ --seed 0
  mmweaver generate --rgb rgb.png --depth depth.npy --text "a person sits down and drinks" \\
      --seconds 8 --radar mmmesh --out drink/ --bin
  mmweaver generate --views views.json --text "a person walks" --out walk/    # several photos: the whole room
  mmweaver generate --capture scan/ --further-photos auto --text "a person walks" --out walk/
  mmweaver generate --demo --method physics --out traced/
  mmweaver generate --demo --board ideal --out ideal/               # no errors of a board; --board board.json: of yours
  mmweaver generate --demo --radar-pose 0,0,0,0,0 --radar-pose 1.5,1.5,0,-60,0 --out both/   # two radars at a time
  mmweaver generate --demo --texts sentences.txt --repeat 20 --no-pictures --out set/       # one sentence a line
  mmweaver generate --demo --stream --texts - --out live/                   # sentences from standard input, no end
  mmweaver process empty.bin --radar profile.cfg --out empty/       # your room with nobody in it, a few seconds
  mmweaver generate --rgb rgb.png --depth depth.png --background empty/ --text "a person walks" --out walk/
  mmweaver generate --demo --motion walk.bvh --motion-unit cm --at 0.2,2.5 --heading 0 --out walk/
  mmweaver generate --demo --motion-model small --motion-model-for all --text "a person waves" --out wave/
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "generate", help="generate the signal of a person in the room of a photo", usage=USAGE, epilog=EXAMPLES,
        description="Generates the signal that a radar at the camera would have recorded of a person doing what the"
        " text says, in the room that the photo shows.",
    )  # fmt: skip
    add_generate_options(parser)
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Checks all that is cheap, then generates the signal and writes it. Raises InputError."""
    texts, out = _check_inputs(arguments)
    check_motion_options(arguments)
    if arguments.store or arguments.iq is not None:
        from mmweaver.cli.batch_store import check_store

        check_store(arguments)
    if arguments.stream:
        return _run_stream(arguments, out)
    if arguments.texts is not None:
        return _run_batch(arguments, out)

    from mmweaver.cli.progress import StageBar
    from mmweaver.cli.summary import print_summary
    from mmweaver.core.output_checks import check_output_file, check_output_folder
    from mmweaver.request import parse_request
    from mmweaver.result_folder import FILES

    many = len(arguments.radar_pose or ()) > 1
    files = [REQUEST_FILE] if many else FILES
    check_output_folder(out, overwrite=arguments.overwrite, files=files, inputs=_inputs(arguments))
    if arguments.html is not None:
        if arguments.radar_pose:
            raise InputError("--html shows a radar at the camera; leave out --radar-pose, or --html")
        check_output_file(arguments.html, overwrite=arguments.overwrite, inputs=_inputs(arguments))
    with StageBar(NUM_STAGES, quiet=arguments.quiet or arguments.verbose) as bar:
        background = _background(arguments)
        radar = _radar(arguments, background)
        if texts is None and arguments.motion is None:
            texts = [DEMO_TEXT]
        text = texts[0] if texts is not None and len(texts) == 1 else texts
        if arguments.motion is None and arguments.motion_model is None:  # before PyTorch starts, which takes 2 s
            parse_request(radar, text, **_settings(arguments), **placing_options(arguments))
        weaver = _weaver(arguments, radar, bar)
        motion = read_own_motion(arguments) or _motion_of_model(arguments, weaver, text)
        placing = placing_options(arguments, of_model=motion if arguments.motion is None else None)
        request = weaver.request(text, motion=motion, **_settings(arguments), **placing)
        result = weaver.carry_out(request, _read_room(weaver, arguments, background))
        written = {REQUEST_FILE: _request_toml(arguments, text=texts, frames=request.frames, seconds=None)}
        meta = result.save(out, overwrite=arguments.overwrite, extra=written, **_output(arguments))
        if arguments.html is not None:
            result.save_html(arguments.html)
    print_summary(out, meta, as_json=arguments.json, quiet=arguments.quiet, verbose=arguments.verbose)
    return 0


def _run_stream(arguments: argparse.Namespace, out: Path) -> int:
    """One sentence after the other, written as they come."""
    from mmweaver.cli.stream import check_stream_options, run_stream
    from mmweaver.core.output_checks import check_output_folder, is_empty
    from mmweaver.core.staging import sweep
    from mmweaver.result_folder import plain
    from mmweaver.stream_folder import PARTS

    check_stream_options(arguments)
    check_output_folder(out, overwrite=True, inputs=_inputs(arguments))
    sweep(out / PARTS)
    if out.is_dir() and not is_empty(out):
        raise InputError(_why_no_stream_into(out))
    background = _background(arguments)
    weaver = _weaver(arguments, _radar(arguments, background))
    meta = run_stream(arguments, weaver, _read_room(weaver, arguments, background), out, _board(arguments))
    if arguments.json:
        print(json.dumps(plain({"out": str(out), "frames": meta["frames"], "parts": meta["parts"]}), indent=2))
    elif not arguments.quiet:
        print(f"wrote {out}: {meta['frames']} frames in {meta['parts']} parts")
    return 0


def _why_no_stream_into(out: Path) -> str:
    """What to do where a stream's folder holds something already, an interrupted stream mostly."""
    from mmweaver.stream_folder import LIST

    if (out / LIST).is_file():
        return (
            f"{out} holds a stream already, and streams cannot be continued; choose another --out, or delete that"
            " folder (`mmweaver verify` checks and `mmweaver compress` reads what it holds, even after an interruption)"
        )
    return f"{out} is not empty; a stream needs a folder of its own: choose another --out"


def _run_batch(arguments: argparse.Namespace, out: Path) -> int:
    """Many sequences in one room."""
    from mmweaver.cli import batch as many
    from mmweaver.cli.batch_store import run_store
    from mmweaver.core.output_checks import check_output_folder

    check_output_folder(out, overwrite=True, files=[many.LIST, many.LEAKS], inputs=_inputs(arguments))
    texts, matched = many.checked_texts(arguments), arguments.draws == "matched"
    background = _background(arguments)
    weaver = _weaver(arguments, _radar(arguments, background))
    settings = _settings(arguments)
    if not matched:
        given = many.given_placing(arguments)
        placing = placing_options(arguments) | {"at": given.start_m, "height_m": given.height_m}
        settings |= placing | {"subject": given.subject}
    requests = many.parse_texts(weaver, texts, settings, arguments.texts, equally_long=matched)
    room = _read_room(weaver, arguments, background)
    if arguments.store:
        return run_store(arguments, weaver, room, requests, out)
    sequences, refused = many.free_sequences(texts, arguments, out), []
    if matched:
        sequences, refused = many.matched_sequences(texts, requests, room, arguments, out)
    batch = many.Batch(
        weaver=weaver, room=room, requests=requests, output=_output(arguments), overwrite=arguments.overwrite,
        quiet=arguments.quiet,
        request_toml=lambda one: _request_toml(
            arguments, text=[one.text], seed=one.seed, texts=None, repeat=None, frames=requests[one.text].frames,
            seconds=None, **one.placing(),
        ),
    )  # fmt: skip
    summary = batch.run(sequences, refused)
    if arguments.json:
        print(json.dumps(summary, indent=2, ensure_ascii=False))
    elif not arguments.quiet:
        print(many.summary_text(summary))
    return 0


def _inputs(arguments: argparse.Namespace) -> list[Path | None]:
    """Files that an output must not replace."""
    given = (arguments.rgb, arguments.depth, arguments.background, arguments.motion, arguments.texts)
    return [None if one is None else Path(one) for one in given]


def _request_toml(arguments: argparse.Namespace, **instead: Any) -> str:
    radar = arguments.radar or (DEFAULT_RADAR if arguments.background is None else None)
    return request_toml(arguments.parser, arguments, **{"radar": radar, "board": _board(arguments), **instead})


def _board(arguments: argparse.Namespace) -> str | None:
    """The board by name; a typical one with the number of the seed, the same for all sequences of a run.

    None: that of the background recording.
    """
    name = arguments.board or ("typical" if arguments.background is None else None)
    return f"typical:{arguments.seed % 2**31}" if name == "typical" else name


def _radar(arguments: argparse.Namespace, background: "RadarCube | None") -> "RadarConfig":
    """The radar asked for, else that of the background recording, else the default."""
    from mmweaver.core.range_window import chosen_range
    from mmweaver.formats.radar_file import load_radar

    radar = (
        background.config
        if background and not arguments.radar
        else load_radar(radar_of(arguments, DEFAULT_RADAR) or "")
    )
    radar = chosen_range(radar, arguments.range_m, arguments.range_bins)
    return radar if arguments.tx_order is None else replace(radar, tx_order=arguments.tx_order)


def _weaver(
    arguments: argparse.Namespace, radar: "RadarConfig", listener: "Callable[[str], object] | None" = None
) -> "Weaver":
    from mmweaver.formats.radar_file import load_firmware
    from mmweaver.formats.ti_calibration import read_ti_calibration
    from mmweaver.generate import Weaver

    firmware = load_firmware(arguments.radar or DEFAULT_RADAR) if arguments.points == "firmware" else None
    return Weaver(
        method=arguments.method, radar=radar, listener=listener, points=arguments.points, firmware=firmware,
        weights=arguments.weights, calibration=read_ti_calibration(radar_of(arguments, DEFAULT_RADAR) or ""),
        bounces=arguments.bounces, clutter=arguments.clutter,
    )  # fmt: skip


def _settings(arguments: argparse.Namespace) -> dict[str, Any]:
    """The arguments of `Weaver.request` that every sequence shares."""
    return {
        "frames": arguments.frames, "seconds": arguments.seconds, "fps": arguments.fps, "seed": arguments.seed,
        "keep_adc": arguments.bin, "board": _board(arguments), "radar_poses": arguments.radar_pose or (),
    }  # fmt: skip


def _output(arguments: argparse.Namespace) -> dict[str, Any]:
    """The arguments of `Generation.save` that say which files are written."""
    return {
        "adc_data_bin": arguments.bin, "iq_order": arguments.iq_order, "pictures": not arguments.no_pictures,
    }  # fmt: skip


def _motion_of_model(
    arguments: argparse.Namespace, weaver: "Weaver", text: str | list[str] | None
) -> "MotionClip | None":
    """The motion that --motion-model makes of the text."""
    if arguments.motion_model is None:
        return None
    if isinstance(text, list):
        raise InputError("--motion-model acts out one text; give --text once")
    return motion_of_model(arguments, text, _duration_s(arguments, weaver))


def _duration_s(arguments: argparse.Namespace, weaver: "Weaver") -> float | None:
    """The duration that --frames or --seconds fix."""
    if arguments.frames is None:
        return arguments.seconds
    return arguments.frames * (1 / arguments.fps if arguments.fps else weaver.radar.frame_period_s)


def _check_inputs(arguments: argparse.Namespace) -> tuple[list[str] | None, Path]:
    """The texts (None: those of the demo, or a recorded motion alone) and the output folder, if the room is clear."""
    pictures = (
        arguments.rgb, arguments.depth, arguments.camera, arguments.capture, arguments.depth_model, arguments.classes,
        arguments.segmenter, arguments.sam, arguments.views, arguments.mesh,
    )  # fmt: skip
    if arguments.demo:
        if any(picture is not None for picture in pictures):
            raise InputError(
                "--demo brings its own room; leave out --rgb, --depth, --camera and all else that describes a room,"
                " or leave out --demo"
            )
        return arguments.text, arguments.out or Path(DEMO_OUT)
    _check_room(arguments, pictures)
    if any(given is not None for given in (arguments.mesh, arguments.views, arguments.capture)):
        return _text_and_out(arguments)
    if arguments.rgb is None and arguments.depth is None:
        raise InputError("which room? give --rgb and --depth, or try --demo")
    if arguments.depth is None and arguments.depth_model is None:
        raise InputError(
            "--rgb needs --depth too, for the room is built from the distance of each pixel; a metric depth model can"
            " estimate it: --depth-model auto (downloaded once), DIR or a Hub name"
        )
    if arguments.rgb is None:
        raise InputError("--depth needs --rgb too: the colour picture of the same view")
    return _text_and_out(arguments)


def _check_room(arguments: argparse.Namespace, pictures: tuple[Any, ...]) -> None:
    """Raises InputError where a mesh, several photos or a capture come with what describes another room."""
    is_of_mesh = any(
        getattr(arguments, f"mesh_{name}") is not None for name in ("eye", "look", "unit", "up", "materials")
    )
    if arguments.mesh is not None:
        if any(picture is not None for picture in pictures[:-1]):
            raise InputError("--mesh brings the whole room; leave out --rgb, --depth, --camera and all else that does")
    elif is_of_mesh:
        raise InputError("options of a mesh need --mesh FILE")
    if arguments.further_photos is not None and arguments.capture is None:
        raise InputError("--further-photos are those of a scan; give --capture, or leave out --further-photos")
    if arguments.views is not None and any(given is not None for given in (*pictures[:6], arguments.sam)):
        raise InputError("--views names its own photos; leave out --rgb, --depth, --camera and all else that does")
    brought = (arguments.depth, arguments.camera, arguments.depth_model)
    if arguments.capture is not None and any(given is not None for given in brought):
        raise InputError("--capture brings its own depth and camera; leave out --depth, --camera and --depth-model")


def _text_and_out(arguments: argparse.Namespace) -> tuple[list[str] | None, Path]:
    if arguments.text is None and arguments.motion is None and arguments.texts is None:
        raise InputError(
            "what does the person do? give --text, for example --text 'a person walks to the left', or --motion"
        )
    if arguments.out is None:
        raise InputError("where to? give --out, a folder for the results")
    return arguments.text, arguments.out


def _read_room(weaver: "Weaver", arguments: argparse.Namespace, background: "RadarCube | None") -> "Room":
    room = _photographed_room(weaver, arguments)
    room = room.with_landmarks(*arguments.landmark) if arguments.landmark else room
    return room if background is None else room.with_background(background, came_from=arguments.background)


def _background(arguments: argparse.Namespace) -> "RadarCube | None":
    """The background recording, if one is given. Raises InputError for what is no recording."""
    if arguments.background is None:
        return None
    from mmweaver.recordings.read_recording import read_recording

    return read_recording(arguments.background, range_m=arguments.range_m, range_bins=arguments.range_bins).cube


def _further(words: str | None) -> list[int] | str:
    if words is None or words == "auto":
        return words or []
    numbers = words.split(",")
    if not all(number.strip().isdigit() for number in numbers):
        raise InputError(f"--further-photos {words[:40]!r} are no numbers of photos; write 60,120,180, or auto")
    return [int(number) for number in numbers]


def _photographed_room(weaver: "Weaver", arguments: argparse.Namespace) -> "Room":
    if arguments.demo:
        return weaver.sample_room()
    if arguments.mesh is not None:
        return weaver.read_mesh(
            arguments.mesh, eye=arguments.mesh_eye, look_deg=arguments.mesh_look, unit=arguments.mesh_unit,
            up=arguments.mesh_up, materials=arguments.mesh_materials,
        )  # fmt: skip
    labels = {"classes": arguments.classes, "segmenter": arguments.segmenter, "sam": arguments.sam}
    if arguments.capture is not None:
        return weaver.read_capture(
            arguments.capture, photo=arguments.photo, rgb=arguments.rgb, further=_further(arguments.further_photos),
            **labels,
        )  # fmt: skip
    if arguments.views is not None:
        return weaver.read_views(arguments.views, segmenter=arguments.segmenter)
    return weaver.read_room(
        arguments.rgb, arguments.depth, arguments.camera, depth_model=arguments.depth_model, **labels
    )
