"""The request of `Weaver.generate` as one typed record.

It is the source of the keywords of `Weaver.generate`, of the options of `mmweaver generate`, of request.toml and of the
studio's form. Imports are kept light.
"""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from mmweaver.core.options import Place, Source, option, options

if TYPE_CHECKING:
    from mmweaver.core.board import Board
    from mmweaver.core.radar_pose import RadarPose
    from mmweaver.core.targets import Interferer, Reflector, Thing
    from mmweaver.motion.mocap.clip import MotionClip


class Heading(float):
    """A direction in radians from +x towards +y; on the command line in degrees with 0 towards the radar."""

    @classmethod
    def of_words(cls, word: str) -> "Heading":
        """'90' -> 0.0, to the right of the picture."""
        degrees = float(word)
        if not math.isfinite(degrees):
            raise ValueError
        return cls(math.radians(degrees) - math.pi / 2)

    @property
    def words(self) -> str:
        """The direction in the form that `of_words` reads."""
        return repr(round(math.degrees(self) + 90, 10))


def radar_pose(word: str) -> "RadarPose":
    """Parses '0.5,0,0.2,-30,10': position of a radar in metres, yaw and pitch in degrees.

    Raises:
        InputError: For any other form.
    """
    from mmweaver.core.radar_pose import RadarPose

    return RadarPose.of_words(word)


def reflector(word: str) -> "Reflector":
    """Parses '0.5,2,0,10': place of a reflector in metres and its cross section in dBsm.

    Raises:
        InputError: For any other form.
    """
    from mmweaver.core.targets import Reflector

    return Reflector.of_words(word)


def thing(word: str) -> "Thing":
    """Parses 'fan=1,2': a thing that moves and its place in metres.

    Raises:
        InputError: For any other form.
    """
    from mmweaver.core.targets import Thing

    return Thing.of_words(word)


def interferer(word: str) -> "Interferer":
    """Parses '0.5,3,0': place of another radar in metres.

    Raises:
        InputError: For any other form.
    """
    from mmweaver.core.targets import Interferer

    return Interferer.of_words(word)


@options
class Request:
    """The request. A value is that of the only person, or a list with one value per person (None: sampled)."""

    text: str | Sequence[str] | None = option(
        "what the person does; give it once more for each further person; 'nobody' is an empty room",
        "TEXT",
        kind=str,
        many=True,
        group="motion",
    )
    motion: "MotionClip | None" = None  # the first person's recorded motion, which its text then only names
    at: Place | Sequence[Place | None] | None = option(
        "where the person starts: metres right of and ahead of the radar (default: chosen); of several people the first"
        " --at is the first one's",
        "X,Y",
        kind=Place,
        many=True,
    )
    heading_rad: float | None = option(
        "the direction that the person faces first, in degrees: 0 towards the radar, 90 to the picture's"
        " right, 180 away (default: as the text says, else by seed)",
        "DEG",
        kind=Heading,
        name="heading",
        rare=True,
    )
    path_m: Sequence[Place] | None = option(
        "where the person walks: corners in metres right of and ahead of the radar",
        "'X,Y X,Y ...'",
        kind=tuple[Place, ...],
        name="path",
        rare=True,
    )
    height_m: float | Sequence[float | None] | None = option(
        "the person's height in metres (default: as the text says, else by seed, or recorded); of several"
        " people once for each",
        "M",
        kind=float,
        many=True,
        name="height",
    )
    subject: int | Sequence[int | None] | None = option(
        "the person, 0 to 9999: skin, build, habits and usual height (default: by seed); of several people once for"
        " each",
        "N",
        kind=int,
        many=True,
    )
    missing: Literal["stand-in", "furnish", "refuse"] = option(
        "a thing that the text names and the room lacks: a place of the room stands for it, which is reported"
        " (stand-in, the default), a piece of furniture is put there (furnish), or the text is refused (refuse)",
        "stand-in|furnish|refuse",
        default="stand-in",
        rare=True,
    )
    parser: str | None = option(
        "who reads the text instead of the built-in grammar: a language model of yours at an OpenAI-compatible URL"
        " (http://localhost:8000/v1#NAME), in a folder for transformers, or a plug-in module:attribute; what it returns"
        " is checked and cached (docs/motion.md)",
        "URL|DIR|PLUGIN",
        rare=True,
    )
    strict: bool = option(
        "refuse a text of which something is not done as it says, measured on the joints; otherwise it is reported",
        default=False,
    )
    as_recorded: bool = option(
        "the motion's positions are the radar's own (x right, y away, z up); nothing is moved or checked",
        default=False,
        rare=True,
    )
    frames: int | None = option(
        "number of frames (default: as long as the sentence needs, at least 2 s, or as the recorded motion lasts)",
        "N",
        group="radar",
    )
    seconds: float | None = option("instead of --frames: duration in seconds", "S")
    fps: float | None = option("frames per second (default: the radar's own, 10 for awr1843)", "N")
    radar_poses: "Sequence[RadarPose]" = option(
        "where the radar stands, in metres right of, ahead of and above the camera, and degrees to which it is turned"
        " to the right, up, and about its boresight (default: at the camera, level); once more for each further radar,"
        " which records the same scene at the same time (docs/several_radars.md)",
        "X,Y,Z,YAW,PITCH[,ROLL]",
        default=(),
        kind=radar_pose,
        many=True,
        name="radar-pose",
    )
    reflectors: "Sequence[Reflector]" = option(
        "a reflector of known cross section: metres right of, ahead of and above the camera, dBsm, and perhaps corner"
        " (default, facing the camera), sphere or plate; once more for each further one (docs/things.md)",
        "X,Y,Z,DBSM[,SHAPE]",
        default=(),
        kind=reflector,
        many=True,
        name="reflector",
    )
    things: "Sequence[Thing]" = option(
        "a moving thing that is not a person, at metres right of and ahead of the camera (default: a free place by"
        " seed), facing DEG degrees (0 towards the camera): fan, ceiling_fan, curtain, door, vacuum, cat, dog, plant,"
        " washing_machine; once more for each further one (docs/things.md)",
        "KIND[=X,Y[,DEG]]",
        default=(),
        kind=thing,
        many=True,
        name="thing",
    )
    interferers: "Sequence[Interferer]" = option(
        "another FMCW radar that faces the camera, at metres right of, ahead of and above it, and perhaps its EIRP in"
        " dBm (default 22.5): its chirps cross those of the radar (docs/things.md)",
        "X,Y,Z[,DBM]",
        default=(),
        kind=interferer,
        many=True,
        name="interferer",
        rare=True,
    )
    board: "str | Path | Board | None" = option(
        "the board whose errors the signal has: typical, sampled by the seed from the spread of recorded boards"
        " (default; typical:N is one of them), ideal, or a board.json of mmweaver calibrate; with --background the"
        " default is the recording's own",
        "typical|ideal|FILE",
        kind=Source,
    )
    seed: int = option("the same seed gives the same bits", "N", default=0, group="output")
    keep_adc: bool = option("also write adc_data.bin, raw samples as a DCA1000 does", default=False, name="bin")

    @property
    def sentences(self) -> list[str]:
        """One text per person; that of a recorded motion may be empty."""
        return [self.text or ""] if self.text is None or isinstance(self.text, str) else list(self.text)
