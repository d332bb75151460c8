"""Recordings of the user as training examples: radar, a photo of the room, and joints if known.

A folder is one of

    a folder of mmweaver generate or process     radar.npz, radar.json
    a capture folder of mmwave-capture-std       radar.cfg, dca.pcap

and may contain `pose.npz` (22 joints of one person at any times, in the radar's frame). The photo is rgb.png with
depth.png or depth.npy and camera.json, in the folder or its parent; else the one named in meta.json; else the
RealSense's.
"""

import hashlib
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.checksums import sha256_of_file
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, PoseSequence, RadarCube, RgbdPhoto
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.core.skeleton import NUM_JOINTS
from mmweaver.datasets.checked_folder import CheckedFolder
from mmweaver.datasets.dataset_store import StoredRoom
from mmweaver.io.npz_files import read_poses_npz
from mmweaver.motion.animation.root_path import joints_and_velocities
from mmweaver.recordings.read_recording import read_recording
from mmweaver.scene.photo.capture_photo import photo_folder, read_capture_photo
from mmweaver.scene.photo_files import sample_photo
from mmweaver.scene.read_photo import read_photo
from mmweaver.signal.spectra import noise_power

POSE, META = "pose.npz", "meta.json"
FRAMES = 20  # per sequence of a longer capture
LATE_S = 0.25  # tolerated time without joints at either end
SPLIT = "captured"


@dataclass(frozen=True, kw_only=True)
class Capture:
    """One recording: cube, photo of the room, and the person's joints if known."""

    folder: Path
    cube: RadarCube
    photo: RgbdPhoto
    pose: PoseSequence | None


@dataclass(frozen=True, kw_only=True)
class RecordedRoom(StoredRoom):
    """A capture divided into sequences; unknown joints are nan."""

    values: np.ndarray  # (frame, range, doppler, antenna) in sqrt(mW), or in ADC counts if the scale is unknown
    is_calibrated: bool
    sha256: str

    @property
    def has_joints(self) -> bool:
        """Whether the joints are known."""
        return bool(np.isfinite(self.joints_m).all())

    @property
    def noise_power(self) -> float:
        """Noise power per cell; 0 for a radar with a single loop, which cannot estimate it."""
        return noise_power(self._cube(self.values)) or 0.0

    def cube(self, index: int, frames: np.ndarray | None = None, *, realization: int = 0) -> RadarCube:
        """One sequence or some of its frames.

        Args:
            index: Index of the sequence.
            frames: Indices of frames. Default: all.
            realization: Ignored, since a recording has only one realization.

        Returns:
            The cube.
        """
        length = self.joints_m.shape[1]
        values = self.values[index * length : (index + 1) * length]
        return self._cube(values if frames is None else values[frames])

    def calibrated(self, gain: float) -> "RecordedRoom":
        """Applies an amplitude gain.

        Args:
            gain: Gain in sqrt(mW) per count.

        Returns:
            The calibrated room.
        """
        factor = np.float32(gain)
        return replace(self, values=self.values * factor, static=self.static * factor, is_calibrated=True)

    def _cube(self, values: np.ndarray) -> RadarCube:
        return RadarCube(values=values, grid=CubeGrid.of(self.config, len(values)), config=self.config, scale=1.0)


def read_capture(
    folder: Path, *, rgb: Path | None = None, depth: Path | None = None, camera: Path | None = None
) -> Capture:
    """Reads one capture folder.

    Args:
        folder: The folder.
        rgb: Photo that replaces its own. Default: its own.
        depth: Depth of that photo.
        camera: Intrinsics of that photo.

    Returns:
        The capture.

    Raises:
        InputError: If it lacks a recording or a photo, or joints do not cover its frames.
    """
    cube = read_recording(folder).cube
    photo = _own_photo(folder) if rgb is None else read_photo(rgb, depth, camera)[0]
    people = read_poses_npz(folder / POSE) if (folder / POSE).is_file() else ()
    if len(people) > 1:
        raise InputError(f"{folder / POSE} holds {len(people)} people; a capture is of one person at most")
    pose = people[0] if people else None
    if pose is not None:
        _check_times(folder, pose, cube)
    return Capture(folder=folder, cube=cube, photo=photo, pose=pose)


def rooms_of(captures: Sequence[Capture]) -> list[RecordedRoom]:
    """Converts captures to rooms from which batches are sampled, all divided into sequences of equal length.

    Static clutter is the mean over the frames of a capture.

    Args:
        captures: Captures of one radar.

    Returns:
        One room per capture.

    Raises:
        InputError: If radars differ.
    """
    config = captures[0].cube.config
    for one in captures:
        if replace(one.cube.config, name=config.name) != config:
            raise InputError(f"{one.folder} was recorded with another radar or other settings; tune for one at a time")
    frames = min(FRAMES, *(len(one.cube.values) for one in captures))
    return [_room(one, config, frames) for one in captures]


def _room(capture: Capture, config: RadarConfig, frames: int) -> RecordedRoom:
    cube = capture.cube
    is_calibrated = math.isfinite(cube.scale)
    values = cube.values * np.float32(cube.scale) if is_calibrated else cube.values
    count = len(values) // frames
    shape = (count, frames, NUM_JOINTS, 3)
    joints = velocity = np.full(shape, np.nan, np.float32)
    if capture.pose is not None:
        times_s = cube.grid.frame_time_s[: count * frames] + config.active_time_s / 2
        joints, velocity = (part.reshape(shape) for part in joints_and_velocities(capture.pose, times_s))
    return RecordedRoom(
        files=CheckedFolder(folder=capture.folder, sums=None, made_by=""),
        kind=SPLIT,
        layout=0,
        lighting="",
        given_photo=capture.photo,
        static=values[:, :, config.num_loops // 2].mean(axis=0, dtype=np.complex128).astype(np.complex64),
        joints_m=joints,
        joint_velocity_mps=velocity,
        person=np.zeros(count, int),
        activity=("",) * count,
        text=("",) * count,
        split=(SPLIT,) * count,
        seed=np.zeros(count, int),
        config=config,
        values=values,
        is_calibrated=is_calibrated,
        sha256=hashlib.sha256(np.ascontiguousarray(cube.values).tobytes()).hexdigest(),
    )


def _check_times(folder: Path, pose: PoseSequence, cube: RadarCube) -> None:
    own, wanted = pose.time_s, cube.grid.frame_time_s
    if len(own) < 2 or own[0] > wanted[0] + LATE_S or own[-1] < wanted[-1] - LATE_S:
        raise InputError(
            f"{folder / POSE} has joints from {own[0]:.2f} to {own[-1]:.2f} s, the radar's frames go from"
            f" {wanted[0]:.2f} to {wanted[-1]:.2f} s; cut both to the same time, or leave {POSE} out"
        )


# photos -------------------------------------------------------------------------------------------------------------
def _own_photo(folder: Path) -> RgbdPhoto:
    for place in (folder, folder.parent):
        found = _photo_in(place)
        if found is not None:
            return found
    named = _photo_of_meta(folder / META)
    if named is not None:
        return named
    if photo_folder(folder) is not None:
        return read_capture_photo(folder).photo
    raise InputError(
        f"{folder} has no photo of its room: put rgb.png, depth.png (or depth.npy) and camera.json into it or into the"
        " folder above, or give --rgb and --depth"
    )


def _photo_in(place: Path) -> RgbdPhoto | None:
    rgb, camera = place / "rgb.png", place / "camera.json"
    depths = [place / name for name in ("depth.png", "depth.npy") if (place / name).is_file()]
    if not rgb.is_file() or not depths:
        return None
    return read_photo(rgb, depths[0], camera if camera.is_file() else None)[0]


def _photo_of_meta(meta: Path) -> RgbdPhoto | None:
    """Photo named in a meta.json of `mmweaver generate`. Raises InputError if it has changed since."""
    try:
        inputs: dict[str, Any] = read_json(meta)["inputs"]
    except (InputError, KeyError, TypeError):
        return None
    if "sample" in inputs:
        return sample_photo()[0]
    files: dict[str, Path] = {}
    for name in ("rgb", "depth", "camera"):
        if isinstance(inputs.get(name), dict):
            files[name] = Path(inputs[name]["path"])
            if not files[name].is_file():
                return None
            if sha256_of_file(files[name]) != inputs[name]["sha256"]:
                raise InputError(f"{files[name]} has changed since {meta.parent} was written; give --rgb and --depth")
    return (
        read_photo(files["rgb"], files["depth"], files.get("camera"))[0] if {"rgb", "depth"} <= files.keys() else None
    )
