"""What `Weaver` takes and returns: the room of a photo, and one generated sequence."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.atomic_files import staged_folder
from mmweaver.core.board import Board, read_board
from mmweaver.core.boards import IDEAL_BOARD
from mmweaver.core.errors import InputError
from mmweaver.core.placed_thing import PlacedThing
from mmweaver.core.record_values import ShownByFacts
from mmweaver.core.records import AdcCube, PointCloud, PoseSequence, RadarCube, RgbdPhoto, Scene
from mmweaver.core.stages import Stages
from mmweaver.io.npz_files import write_npz
from mmweaver.io.result_folder import BOARD_FILE, THINGS_FILE, file_digest, plain, radar_folder, save_results
from mmweaver.propagation.things import ThingTruth
from mmweaver.scene.affordances.landmarks import add_landmarks
from mmweaver.scene.photo.capture_photo import PosedPhoto
from mmweaver.viz.figure_data import FigureData
from mmweaver.viz.preview import PREVIEWS, draw_preview

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from torch import Tensor
    from xarray import Dataset

    from mmweaver.viz.sequence import Playback


@dataclass(frozen=True, kw_only=True, repr=False)
class Room(ShownByFacts):
    """A photo, read and reconstructed; usable for any number of sequences."""

    scene: Scene
    inputs: dict[str, Any]
    seconds: dict[str, float]
    background: RadarCube | None = None  # a recording of the empty room by the same radar in the same place
    background_board: Board | None = None  # the board.json that came with it
    views: tuple[PosedPhoto, ...] = ()  # further photos that the scene was reconstructed from

    def facts(self) -> dict[str, str]:
        """Size of the photo, facts of the scene, background and inputs, for display."""
        size = self.scene.photo.facts()["size"]
        background = "none" if self.background is None else f"by {self.background.config.name}"
        return {"photo": size, **self.scene.facts(), "background": background, "inputs": ", ".join(self.inputs)}

    def _repr_html_(self) -> str:
        return _add_picture(super()._repr_html_(), _png_of(self.scene.photo.rgb))

    def with_landmarks(self, *given: PlacedThing | tuple[str, tuple[float, float]]) -> "Room":
        """The room with landmarks at known places, which replace detected ones of the same kind.

        Args:
            *given: Kind and place (metres right of and ahead of the radar), such as `("door", (0.9, 2.8))`, and perhaps
                the direction that its front faces in degrees: 0 towards the radar, 90 to the picture's right.

        Raises:
            InputError: For a kind that is not a destination of sentences.
        """
        things = [PlacedThing.of(one) for one in given]
        return replace(self, scene=add_landmarks(self.scene, things), inputs=self.inputs | {"landmarks": _rows(things)})

    def with_furniture(self, *given: PlacedThing | tuple[str, tuple[float, float]], seed: int = 0) -> "Room":
        """The room with furniture that the photo does not show: it echoes, occludes, takes floor, and can be used.

        Args:
            *given: Kind and place as for `with_landmarks`: bed, desk, table, chair, couch, wardrobe, sink, door, and
                others of `scene.furnished.RECORD_OF`.
            seed: Seed of sizes and colours.

        Raises:
            InputError: For unknown furniture, or a place that is not in front of the radar.
        """
        from mmweaver.scene.furnished import furnished

        things = [PlacedThing.of(one) for one in given]
        items = [(one.kind, one.place_m, one.facing_rad) for one in things]
        there = [*self.inputs.get("furniture", ()), *_rows(things)]
        return replace(self, scene=furnished(self.scene, items, seed), inputs=self.inputs | {"furniture": there})

    def with_background(self, source: str | Path | RadarCube, *, came_from: Path | None = None) -> "Room":
        """The room with a background recording of the empty room by your radar, whose static clutter is used as it is.

        A board.json in the folder of the recording is the board that recorded it; otherwise its errors are estimated.

        Args:
            source: Folder of `mmweaver process` or `generate`, its radar.npz, a capture folder, or the cube.
            came_from: File or folder of the cube, if a cube is given.

        Raises:
            InputError: If the source is not a recording.
        """
        if not isinstance(source, RadarCube):
            from mmweaver.recordings.read_recording import read_recording

            came_from = Path(source)
            source = read_recording(came_from).cube
        inputs = self.inputs if came_from is None else self.inputs | {"background": _recording_digest(came_from)}
        return replace(self, background=source, background_board=_board_next_to(came_from), inputs=inputs)


def _rows(things: list[PlacedThing]) -> list[list[Any]]:
    """Things for meta.json: kind, x, y and, if given, the direction of the front in degrees."""
    return [[one.kind, *one.place_m, *([] if one.facing_deg is None else [one.facing_deg])] for one in things]


def _board_next_to(recording: Path | None) -> Board | None:
    """The board.json in the folder of a recording, None without one."""
    if recording is None:
        return None
    file = (recording.parent if recording.is_file() else recording) / BOARD_FILE
    return read_board(file) if file.is_file() else None


@dataclass(frozen=True, kw_only=True, repr=False)
class Generation(ShownByFacts):
    """One generated sequence.

    Attributes:
        cube: Range-Doppler cube (frame, range, doppler, antenna).
        points: Point cloud of all frames.
        adc: Raw samples, if they were requested.
        poses: Each person's joints at the radar's frames.
        motions: Each person's joints densely in time.
        scene: The room in the radar's coordinates.
        meta: Contents of meta.json.
        stages: Duration of each stage.
        board: Board whose errors the signal has.
        further: Simultaneous signals of other radars.
        things: Ground truth of moving things other than people.
    """

    cube: RadarCube
    points: PointCloud
    adc: AdcCube | None
    poses: tuple[PoseSequence, ...]
    motions: tuple[PoseSequence, ...]
    scene: Scene
    meta: dict[str, Any]
    stages: Stages
    board: Board = IDEAL_BOARD
    further: tuple["Generation", ...] = ()
    things: tuple[ThingTruth, ...] = ()

    @property
    def radars(self) -> tuple["Generation", ...]:
        """The signals of all radars, this one first."""
        return (replace(self, further=()), *self.further)

    def facts(self) -> dict[str, str]:
        """Request and result in short, for display."""
        shape = " x ".join(map(str, self.cube.values.shape))
        return {
            "text": " | ".join([self.meta["text"]] if isinstance(self.meta["text"], str) else self.meta["text"]),
            "cube": f"{shape} (frame, range, doppler, antenna)",
            "points": str(len(self.points.frame)),
            "people": str(len(self.poses)),
            "ADC samples": "none" if self.adc is None else " x ".join(map(str, self.adc.samples.shape)),
            "method": str(self.meta["method"]),
            "radar": self.cube.config.name + (f", one of {len(self.radars)}" if self.further else ""),
            "board": self.board.name,
            "seed": str(self.meta["seed"]),
        }

    def _repr_html_(self) -> str:
        from io import BytesIO

        page = BytesIO()
        self.plot().savefig(page, format="png", dpi=60)
        return _add_picture(super()._repr_html_(), page.getvalue())

    def plot(self) -> "Figure":
        """The page of preview.png as a matplotlib figure."""
        return draw_preview(self.figure_data, None)

    def show(self) -> Any:
        """Plays the sequence in a notebook: room, people, points and maps. Needs the extra 'notebook'."""
        from mmweaver.viz.notebook import player_widget

        return player_widget(*self._playback())

    def save_html(self, path: str | Path) -> None:
        """Writes one HTML file that plays the sequence in any browser, without a server or a network connection.

        Args:
            path: The file.

        Raises:
            InputError: If it cannot be written, or the radar is not at the camera.
        """
        from mmweaver.viz.html_page import write_page

        write_page(Path(path), *self._playback(), self.figure_data.title)

    def _playback(self) -> "tuple[Playback, Playback]":
        """The sequence and its room, for the playback page."""
        from mmweaver.viz.html_page import OFFLINE_ROOM_POINTS
        from mmweaver.viz.sequence import make_playback, room_playback

        if not self.scene.radar_pose.is_at_camera:
            raise InputError("the page shows radars at the camera only; look at preview.png of a radar elsewhere")
        range_m = self.cube.grid.range_m
        window_m = float(range_m[0]), float(range_m[-1])
        sequence = make_playback(self.cube, self.points, self.poses, plain(self.meta))
        return sequence, room_playback(self.scene, "room", window_m, max_points=OFFLINE_ROOM_POINTS)

    def to_xarray(self) -> "Dataset":
        """Cube, joints and points as an xarray Dataset in SI units; needs the extra 'xarray'.

        `cube` has the dimensions frame_time (s), range (m), radial_velocity (m/s) and antenna, `joints`
        person, frame_time, joint and axis; columns of the point cloud have the dimension point.
        """
        from mmweaver.io.conversions import to_dataset

        return to_dataset(self.cube, self.points, self.poses, self.adc, self.meta)

    def to_torch(self) -> "dict[str, Tensor]":
        """Tensors in SI units that share the memory of the arrays where possible.

        `cube` complex64 (frame, range, doppler, antenna) with the axes `frame_time_s`, `range_m`,
        `radial_velocity_mps`, `antenna_position_m`; `joints_m` (person, frame, 22, 3); `points` (point, 6): frame,
        x_m, y_m, z_m, radial_velocity_mps, snr_db; `adc` (frame, loop, tx, rx, sample) where there are samples.
        """
        from mmweaver.io.conversions import to_tensors

        return to_tensors(self.cube, self.points, self.poses, self.adc)

    @property
    def pose(self) -> PoseSequence:
        """The first person's joints at the radar's frames.

        Raises:
            InputError: If the room is empty.
        """
        return _first(self.poses)

    @property
    def motion(self) -> PoseSequence:
        """The first person's joints densely in time.

        Raises:
            InputError: If the room is empty.
        """
        return _first(self.motions)

    @property
    def photo(self) -> RgbdPhoto:
        return self.scene.photo

    @property
    def figure_data(self) -> FigureData:
        """The data that figures are drawn from."""
        text = self.meta["text"]
        title = text if isinstance(text, str) else " | ".join(text)
        pose = self.scene.radar_pose
        elsewhere = "" if pose.is_at_camera else f" at {pose.words}"
        return FigureData(
            title=f"{title}   ({self.cube.config.name}{elsewhere}, seed {self.meta['seed']})",
            cube=self.cube,
            points=self.points,
            aligned=AlignedPhoto.of(self.scene),
            poses=self.poses,
            motions=self.motions,
        )

    def save(
        self,
        out: str | Path,
        *,
        overwrite: bool = False,
        adc_data_bin: bool = False,
        iq_order: str | None = None,
        pictures: bool = True,
        extra: dict[str, str] | None = None,
    ) -> dict[str, Any]:
        """Writes all files and pictures into a folder, or none of them.

        Several radars have one subfolder each, radar_1, radar_2 and so on, with all files except `extra`.

        Args:
            out: The folder.
            overwrite: Whether an existing folder may be replaced.
            adc_data_bin: Whether the raw samples are written, too, in the format of a DCA1000.
            iq_order: Order of I and Q in adc_data.bin, "iq", "qi" or "interleaved"; by default that of the radar.
            pictures: Whether previews are drawn, which takes most of the time.
            extra: Text files to add, by name.

        Returns:
            Contents of meta.json.

        Raises:
            InputError: If the folder cannot be written, holds other files and `overwrite` is not set, or there are no
                samples for `adc_data_bin`.
        """
        if self.further:
            return self._save_each(
                Path(out),
                overwrite=overwrite,
                adc_data_bin=adc_data_bin,
                iq_order=iq_order,
                pictures=pictures,
                extra=extra,
            )
        if adc_data_bin and self.adc is None:
            raise InputError(
                "there are no ADC samples to write; generate with keep_adc=True and a method that has them"
            )
        if not self.board.is_ideal:
            extra = {BOARD_FILE: self.board.to_json(), **(extra or {})}
        return save_results(
            out,
            self.figure_data,
            self.meta,
            adc=self.adc if adc_data_bin else None,
            iq_order=iq_order,
            overwrite=overwrite,
            stages=self.stages,
            pictures=PREVIEWS if pictures else None,
            extra=extra,
            more=self._write_things if self.things else None,
        )

    def _write_things(self, folder: Path) -> None:
        """Writes things.npz: kinds, places and velocities of all things at the radar's frames."""
        write_npz(
            folder / THINGS_FILE,
            kind=np.array([one.kind for one in self.things]),
            place_m=np.stack([one.place_m for one in self.things]),
            velocity_mps=np.stack([one.velocity_mps for one in self.things]),
            frame_time_s=self.cube.grid.frame_time_s,
        )

    def _save_each(self, out: Path, *, overwrite: bool, extra: dict[str, str] | None, **options: Any) -> dict[str, Any]:
        """Writes the folder of each radar, or none; returns the first one's meta.json with all files."""
        with staged_folder(out, overwrite=overwrite) as stage:
            for name, text in (extra or {}).items():
                (stage / name).write_text(text, encoding="utf-8")
            metas = [one.save(stage / radar_folder(number), **options) for number, one in enumerate(self.radars, 1)]
        files = {
            f"{radar_folder(number)}/{name}": text
            for number, meta in enumerate(metas, 1)
            for name, text in meta["files"].items()
        }
        return {**metas[0], "files": files}


def _first(poses: tuple[PoseSequence, ...]) -> PoseSequence:
    if not poses:
        raise InputError("nobody is in this sequence, so there is no pose; `poses` is empty")
    return poses[0]


def _recording_digest(place: Path) -> dict[str, str]:
    """Path of a recording and, for a file or a folder's radar.npz, its sha256."""
    file = next((one for one in (place, place / "radar.npz") if one.is_file()), None)
    return {"path": str(place)} if file is None else file_digest(file)


def _png_of(rgb: np.ndarray, width: int = 320) -> bytes:
    """A small PNG of a picture (height, width, 3)."""
    from io import BytesIO

    from PIL import Image

    picture = Image.fromarray(rgb)
    picture.thumbnail((width, width))
    out = BytesIO()
    picture.save(out, format="PNG")
    return out.getvalue()


def _add_picture(table: str, png: bytes) -> str:
    from base64 import b64encode

    return f"{table}<img src='data:image/png;base64,{b64encode(png).decode()}' style='max-width:100%'/>"
