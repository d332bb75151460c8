"""mmweaver generate: photo and sentence in, radar signal out."""

from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from mmweaver.cli.arguments import REQUEST_FILE, request_toml
from mmweaver.cli.generate_inputs import DEFAULT_RADAR, radar_of, read_background, room_of, weaver_of
from mmweaver.cli.option_groups import Layout, PointChoice, RadarChoice, Ranges, Written
from mmweaver.core.errors import InputError
from mmweaver.core.options import Setting, Source, option, options, read_settings
from mmweaver.core.placed_thing import PlacedThing
from mmweaver.weaver.request import Request

if TYPE_CHECKING:
    from mmweaver.motion.mocap.clip import MotionClip
    from mmweaver.weaver.front_door import Weaver
    from mmweaver.weaver.generation import Room

DEMO_TEXT = "a person walks towards the radar, then waves with the left hand"
DEMO_OUT = "demo"
NUM_STAGES = 9
PICTURES = (".png", ".npy", ".tif", ".tiff", ".webp", ".jpg", ".jpeg")
USAGE = """mmweaver generate --demo
       mmweaver generate --rgb PNG --depth FILE --text TEXT --out DIR [options]
       mmweaver generate --room PATH --text TEXT --out DIR [options]
       mmweaver generate --config request.toml --out DIR [options]"""
EXAMPLES = """examples:
  mmweaver generate --demo
  mmweaver generate --rgb rgb.png --depth depth.png --camera camera.json \\
      --text "a person walks towards the radar, then waves with the left hand" --out walk/ --seed 0
  mmweaver generate --rgb rgb.png --depth depth.npy --text "a person sits down and drinks" \\
      --seconds 8 --radar mmmesh --out drink/ --bin
  mmweaver generate --room views.json --text "a person walks" --out walk/     # several photos: the whole room
  mmweaver generate --room scan/ --extra-views auto --text "a person walks" --out walk/
  mmweaver generate --demo --method physics --out traced/
  mmweaver generate --demo --board ideal --out ideal/               # no errors of a board; --board board.json: of yours
  mmweaver generate --demo --radar-pose 0,0,0,0,0 --radar-pose 1.5,1.5,0,-60,0 --out both/   # two radars at a time
  mmweaver generate --demo --texts sentences.txt --per-class 20 --no-pictures --out set/    # one sentence per line
  mmweaver generate --demo --stream --texts - --out live/                   # sentences from standard input, no end
  mmweaver process empty.bin --radar profile.cfg --out empty/       # your room with nobody in it, a few seconds
  mmweaver generate --rgb rgb.png --depth depth.png --background empty/ --text "a person walks" --out walk/
  mmweaver generate --demo --motion walk.bvh --motion-set unit=cm --at 0.2,2.5 --heading 0 --out walk/
  mmweaver generate --demo --motion-model small --motion-set for=all --text "a person waves" --out wave/
"""
_MESH_SETTINGS = {"eye": tuple[float, float, float], "look": float, "unit": str, "up": str, "materials": Path}
_MOTION_SETTINGS = {
    "fps": float,
    "unit": str,
    "up": str,
    "start": float,
    "clip": str,
    "body": Path,
    "for": str,
}


@options
class RoomInput:
    """Source of the room."""

    demo: bool = option(f"the bundled sample room (and --out {DEMO_OUT})", default=False, group="input")
    rgb: Path | None = option("colour picture of the room", "PNG")
    depth: Source | None = option(
        "its depth: 16-bit PNG, .npy or float TIFF in metres; or a metric depth model that"
        " estimates it: auto (downloaded once), a folder or a Hub name",
        "FILE|auto|MODEL",
    )
    depth_unit: str | None = option(
        "unit of a depth picture of integers: mm, cm, tum (5000 a metre, also ICL-NUIM), replica (6553.5), kitti (256,"
        " also VOID), 4000, 10000, sunrgbd, or the metres in one count (default: camera.json's depth_unit_m, else"
        " estimated from the room)",
        "NAME|METRES",
        rare=True,
    )
    depth_kind: Literal["z", "ray", "disparity"] | None = option(
        "what the depth picture holds: depth along the optical axis, distance along the ray, or a Kinect's disparities"
        " (default: z, or ray where only then surfaces are flat)",
        rare=True,
    )
    camera: Path | None = option("fx, fy, cx, cy in pixels (default: a RealSense D455's)", "JSON")
    room: Path | None = option(
        "instead of --rgb, --depth and --camera: a folder with rgb.png, depth.png and camera.json;"
        " views.json, several photos with depth and"
        " roughly where each was taken (docs/photos.md); a scan or capture (mmwave-capture-std, Stray Scanner,"
        " Record3D, Polycam raw data, ScanNet, TUM RGB-D), a ROS bag (RealSense), or a mesh (.glb, .ply, .obj)",
        "PATH",
    )
    background: Path | None = option(
        "a recording of this room by your radar with nobody present, a folder of mmweaver process or a capture folder:"
        " its static clutter is used as it is, and the person is added",
        "DIR|NPZ",
    )
    classes: Source | None = option(
        "what each pixel shows, from which materials follow: a picture (COCO-Stuff's numbers), or a model that finds"
        " it: builtin, or a SegFormer, MaskFormer, Mask2Former ... by folder or Hub name",
        "PNG|builtin|MODEL",
        rare=True,
    )
    landmark: list[PlacedThing] | None = option(
        "where a thing that the text names is, if the photo does not show it well (door, table, sink, bin ...): metres"
        " right of and ahead of the radar, for example door=0.9,2.8, and perhaps the direction that its front faces, in"
        " degrees as for --heading",
        "KIND=X,Y[,FACING]",
        rare=True,
    )
    furnish: list[PlacedThing] | None = option(
        "put furniture that the photo does not show into the room (bed, desk, table, chair, couch, wardrobe, sink, door"
        " ...), as for --landmark; it echoes and occludes, and people use it",
        "KIND=X,Y[,FACING]",
        rare=True,
    )
    photo: int | None = option("which photo of a scan or capture (default 0)", "N", rare=True)
    extra_views: str | None = option(
        "further photos of a scan, joined to --photo by its poses, so that walls beside and behind the radar are known:"
        " numbers, or auto for up to five that show the most",
        "N,N..|auto",
        rare=True,
    )
    mesh_set: list[Setting] | None = option(
        "of a mesh: eye=X,Y,Z, the radar's place in the mesh's own axes and unit (default: near a wall, with the room"
        " ahead); look=DEG, degrees from the mesh's x axis, counterclockwise from above (default: most room); unit=m,"
        " cm, mm, inch or foot (default: what fits a room); up=y or z (default: y for .glb, else by the floor);"
        ' materials=JSON, what its names are: {"Material.003": "couch", "pane": "glass"}',
        "KEY=VALUE",
        rare=True,
    )

    def read_room(self, weaver: "Weaver") -> "Room":
        """Reads and reconstructs the room.

        Args:
            weaver: Reader of rooms.

        Raises:
            InputError: For options of another kind of room.
        """
        if self.demo:
            return weaver.sample_room()
        how: dict[str, Any] = {}
        if self.classes is not None:
            how[_picture_or("segmenter", "classes", self.classes)] = self.classes
        if self.room is None:
            assert self.rgb is not None
            if self.depth is not None:
                how[_picture_or("depth_model", "depth", self.depth)] = self.depth
            how |= {"depth_unit": self.depth_unit, "depth_kind": self.depth_kind}
            return weaver.read_room(self.rgb, camera=self.camera, **how)
        mesh = read_settings(self.mesh_set, _MESH_SETTINGS, "mesh-set")
        how |= {"look_deg" if name == "look" else name: value for name, value in mesh.items()}
        how |= {"photo": self.photo, "rgb": self.rgb, "extra_views": _photos(self.extra_views)}
        how |= {"depth_unit": self.depth_unit, "depth_kind": self.depth_kind}
        return weaver.open_room(self.room, **{name: value for name, value in how.items() if value is not None})

    def check_room(self) -> None:
        """Checks that exactly one room is given.

        Raises:
            InputError: If no room or two are given.
        """
        given = [name for name in ("room", "depth", "camera", "rgb", "classes") if getattr(self, name) is not None]
        if self.demo and given:
            raise InputError(
                "--demo brings its own room; leave out --room, --rgb, --depth, --camera and all else that describes a"
                " room, or leave out --demo"
            )
        if self.room is not None and (given_too := {"depth", "camera"} & set(given)):
            raise InputError(f"--room brings the whole room; leave out {' and '.join(f'--{one}' for one in given_too)}")
        if self.demo or self.room is not None:
            return
        if self.rgb is None and self.depth is None:
            raise InputError("which room? give --rgb and --depth, or --room, or try --demo")
        if self.rgb is None:
            raise InputError("--depth needs --rgb too: the colour picture of the same view")
        if self.depth is None:
            raise InputError(
                "--rgb needs --depth too, for the room is built from the distance of each pixel; a metric depth model"
                " can estimate it: --depth auto (downloaded once), a folder or a Hub name"
            )
        if (self.photo, self.extra_views, self.mesh_set) != (None, None, None):
            raise InputError("--photo, --extra-views and --mesh-set are of a scan or mesh; give --room, too")


@options
class MotionInput:
    """Motions from sources other than one sentence."""

    motion_file: Path | None = option(
        "a recorded motion instead of the first --text, which then only names it: .bvh, .npz (AMASS, SMPL, CMU,"
        " joints), .npy (22 joints, HumanML3D)",
        "FILE",
        name="motion",
        group="motion",
    )
    motion_model: Source | None = option(
        "a motion model for a --text that the built-in library does not know: MotionGPT (a checkpoint's file, folder or"
        " name on the Hub, or 'small'; needs the extra 'pretrained'), a plug-in's name, or module:attribute",
        "PATH|NAME",
        rare=True,
    )
    motion_set: list[Setting] | None = option(
        "of a recorded motion: fps=N, where the file does not say; unit=m, cm, mm, inch or metres in one unit (default:"
        " by body size); up=y, z, ... (default: where the head is); start=S, the second at which it begins; clip=NAME,"
        " where a file holds several; body=NPZ, your own SMPL model, for bones in the recorded shape; of a motion"
        " model: for=all, known sentences, too",
        "KEY=VALUE",
        rare=True,
    )
    texts: Path | None = option(
        "many sequences, one sentence per line of this file, each in its own folder under --out; the room is read once,"
        " and finished sequences are kept",
        "FILE",
    )
    stream: bool = option(
        "one recording of one person who does what every --text, line of --texts or of standard input (--texts -) says,"
        " without a break, written part by part for as long as sentences come",
        default=False,
    )
    per_class: int | None = option("with --texts: N of each sentence (default 1), at the same places", "N", rare=True)


@options
class Advanced(Layout):
    """Method that makes the signal."""

    method: str = option(
        "which paths make the signal: weaver, those of the trained network (also called auto), or physics, those of the"
        " ray tracer, at about five times the cost",
        "NAME",
        default="auto",
        group="advanced",
    )
    weights: Source | None = option(
        "the network's weights: a file or folder of mmweaver train, or a name on the Hub", "FILE|DIR|HUB"
    )
    method_set: list[Setting] | None = option(
        "leave out of weaver and physics: bounces=1, paths over body and room, or over two surfaces; clutter=resolved,"
        " static clutter that photo and mesh do not resolve",
        "KEY=VALUE",
        rare=True,
    )


@options
class Results(Written):
    """Output files."""

    out: Path | None = option(
        "folder for the results (default with --demo: demo)", "DIR", group="output", is_setting=False
    )
    no_pictures: bool = option("leave out preview.png and preview.gif", default=False)


@options
class Options(RoomInput, Request, MotionInput, RadarChoice, Ranges, PointChoice, Advanced, Results):
    """Generates the signal that a radar at the camera would have recorded of a person doing what the text says, in the
    room that the photo shows.
    """

    GROUPS: ClassVar[dict[str, str]] = {"text": "motion", "radar": "radar"}

    def asked(self, **instead: Any) -> Request:
        """The request of one sequence."""
        given: dict[str, Any] = {one.name: getattr(self, one.name) for one in fields(Request)} | instead
        for name in ("text", "at", "height_m", "subject"):  # of one person the value, of several a list
            value, people = given[name], len(given["text"] or [""])
            if isinstance(value, list) and len(value) == 1 and (name == "text" or people == 1):
                given[name] = value[0]
        given["board"] = self.board_name()
        return Request(**given)

    def of_one_person(self, why: str) -> dict[str, Any]:
        """Place, height and number of the only person. Raises InputError where several are given."""
        given: dict[str, Any] = {name: getattr(self, name) for name in ("at", "height_m", "subject")}
        for name, values in given.items():
            if len(values or ()) > 1:
                raise InputError(f"{why}; give --{name.removesuffix('_m')} once")
        return {name: values[0] if values else None for name, values in given.items()}

    def board_name(self) -> str | None:
        """Name of the board; a typical one is numbered by the seed, and the same for all sequences of a run.

        None for the board of the background recording.
        """
        name: Any = self.board or ("typical" if self.background is None else None)
        return f"typical:{self.seed % 2**31}" if name == "typical" else name and str(name)

    def request_toml(self, **instead: Any) -> str:
        """The options of one sequence as TOML."""
        radar = self.radar or (DEFAULT_RADAR if self.background is None else None)
        return request_toml(self, **{"radar": radar, "board": self.board_name(), **instead})

    @property
    def inputs(self) -> list[Any]:
        """Files that an output must not replace."""
        return [self.rgb, self.depth and Path(self.depth), self.background, self.motion_file, self.texts]

    @property
    def output(self) -> dict[str, Any]:
        """The arguments of `Generation.save` that say which files are written."""
        return {"adc_data_bin": self.keep_adc, "iq_order": self.iq_order, "pictures": not self.no_pictures}

    @property
    def may_widen(self) -> bool:
        """Whether the range window is a preset's, so that a sentence that lacks floor gets a wider one."""
        from mmweaver.core.boards import PRESETS

        return self.range_m is None and self.range_bins is None and self.radar_name(DEFAULT_RADAR) in PRESETS

    @property
    def folder(self) -> Path:
        """The folder for results. Raises InputError where there is none."""
        if self.out is None and not self.demo:
            raise InputError("where to? give --out, a folder for the results")
        return self.out or Path(DEMO_OUT)


def run(asked: Options) -> int:
    """Checks everything that is fast to check, then generates the signal and writes it.

    Raises:
        InputError: For a request that cannot be met.
    """
    asked.check_room()
    if asked.text is None and asked.motion_file is None and asked.texts is None and not asked.demo:
        raise InputError(
            "what does the person do? give --text, for example --text 'a person walks to the left', or --motion"
        )
    out = asked.folder
    _check_motion(asked)
    if asked.stream:
        from mmweaver.cli.stream import run_stream

        return run_stream(asked, out)
    if asked.texts is not None:
        from mmweaver.cli.batch import run_batch

        return run_batch(asked, out)
    if asked.per_class is not None:
        raise InputError("--per-class is for many sequences; give --texts FILE, too")
    return _run_one(asked, out)


def _run_one(asked: Options, out: Path) -> int:
    """One sequence."""
    from mmweaver.cli.progress import StageBar
    from mmweaver.cli.summary import machine_summary, summary_lines
    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.io.result_folder import FILES
    from mmweaver.weaver.parsed_request import parse

    files = [REQUEST_FILE] if len(asked.radar_poses) > 1 else FILES
    check_output_folder(out, overwrite=asked.overwrite, files=files, inputs=asked.inputs)
    with StageBar(NUM_STAGES, quiet=asked.quiet or asked.verbose) as bar:
        background = read_background(asked)
        radar = radar_of(asked, background)
        texts = [DEMO_TEXT] if asked.text is None and asked.motion_file is None else asked.text
        request = asked.asked(text=texts)
        if asked.motion_file is None and asked.motion_model is None:  # before importing PyTorch, which takes 2 s
            parse(request, radar)
        weaver = weaver_of(asked, radar, bar)
        weaver.widens = background is None and asked.may_widen
        parsed = weaver.parsed(_add_motion(asked, request, weaver))
        result = weaver.carry_out(parsed, room_of(asked, weaver, background))
        written = {REQUEST_FILE: asked.request_toml(text=texts, frames=parsed.frames, seconds=None)}
        meta = result.save(out, overwrite=asked.overwrite, extra=written, **asked.output)
    return asked.report(machine_summary(out, meta), *summary_lines(out, meta, verbose=asked.verbose))


def _picture_or(model: str, picture: str, name: str) -> str:
    """Name of the argument of `Weaver.read_room` for a value: that of a picture or that of a model."""
    return picture if Path(name).suffix.lower() in PICTURES else model


def _photos(words: str | None) -> list[int] | str | None:
    if words is None or words == "auto":
        return words
    numbers = words.split(",")
    if not all(number.strip().isdigit() for number in numbers):
        raise InputError(f"--extra-views {words[:40]!r} are no numbers of photos; write 60,120,180, or auto")
    return [int(number) for number in numbers]


# a motion that is not made of a sentence ----------------------------------------------------------------------------
def _check_motion(asked: Options) -> None:
    """Checks the options of motions; InputError if they contradict each other."""
    settings = read_settings(asked.motion_set, _MOTION_SETTINGS, "motion-set")
    if asked.motion_file is not None and asked.motion_model is not None:
        raise InputError("--motion is a recorded motion, --motion-model makes one of --text; give one of them")
    if asked.motion_model is not None and asked.text is None and not asked.demo:
        raise InputError("--motion-model acts out a text; give --text")
    if asked.motion_model is not None and asked.text is not None and len(asked.text) > 1:
        raise InputError("--motion-model acts out one text; give --text once")
    if asked.motion_file is not None:
        if asked.path_m is not None:
            raise InputError("--path is for a sentence; a recorded --motion has its own path, leave one of them out")
        if asked.as_recorded and not (asked.at is None and asked.heading_rad is None):
            raise InputError("--as-recorded moves nothing; leave out --at and --heading, or leave out --as-recorded")
    elif asked.as_recorded:
        raise InputError("--as-recorded is about a recorded motion; give --motion too")
    elif settings and (asked.motion_model is None or set(settings) - {"for"}):
        raise InputError("--motion-set is about a recorded motion; give --motion too")


def _add_motion(asked: Options, request: Request, weaver: "Weaver") -> Request:
    """The request with a recorded motion, or with one that a model generates from its text."""
    from dataclasses import replace

    settings = read_settings(asked.motion_set, _MOTION_SETTINGS, "motion-set")
    if asked.motion_file is not None:
        from mmweaver.motion.mocap.read_motion import read_motion

        names = {"fps": "fps", "unit": "unit", "up": "up", "clip": "clip", "body": "body_model"}
        how = {new: settings[name] for name, new in names.items() if name in settings}
        clip = read_motion(asked.motion_file, **how)
        return replace(request, motion=clip.after(settings["start"]) if "start" in settings else clip)
    if asked.motion_model is None:
        return request
    clip = _motion_of_model(asked, request, settings.get("for") == "all", weaver)
    if clip is None or not request.path_m:
        return replace(request, motion=clip)
    from mmweaver.motion.motion_models import heading_of

    path_m = tuple(request.path_m)
    return replace(request, motion=clip, at=path_m[0], path_m=None, heading_rad=heading_of(path_m, clip))


def _motion_of_model(asked: Options, request: Request, is_of_all: bool, weaver: "Weaver") -> "MotionClip | None":
    """The motion that --motion-model generates from the text; None for a text that the library knows."""
    from mmweaver.motion.language.sentence import parse_sentence
    from mmweaver.motion.motion_models import MotionTask, clip_of, load_motion_model

    assert isinstance(request.text, str)
    assert asked.motion_model is not None
    if not is_of_all:
        try:
            parse_sentence(request.text)
            return None
        except InputError:
            pass
    seconds = request.seconds
    if request.frames is not None:
        seconds = request.frames * (1 / request.fps if request.fps else weaver.radar.frame_period_s)
    path_m = tuple(request.path_m or ())
    start_m: Any = path_m[0] if path_m else request.at
    task = MotionTask(sentence=request.text, start_m=start_m, path_m=path_m, seconds=seconds, seed=request.seed)
    return clip_of(load_motion_model(asked.motion_model), task)
