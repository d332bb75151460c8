"""The small files that the commands of the advice tests name."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import torch
from PIL import Image

from mmweaver.cli import generate, train
from mmweaver.cli.main import main
from mmweaver.core.boards import AWR1843
from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.core.stages import Stages
from mmweaver.io.dca1000 import write_bin
from mmweaver.motion.compose import Motion
from mmweaver.motion.mocap.clip import MotionClip
from mmweaver.motion.mocap.joint_arrays import CMU_NAMES
from mmweaver.motion.motion_models import MotionTask
from mmweaver.scene.photo.estimated_depth import PROMPTED
from mmweaver.scene.photo_files import sample_photo
from mmweaver.training.captures import read_capture
from mmweaver.weaver.composition import compose_request
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Generation, Room
from mmweaver.weaver.parsed_request import ParsedRequest
from tests.captures import CFG
from tests.cli.test_motion_options import waving
from tests.io.test_ti_cfg import BEST_RANGE, SUB_FRAMES
from tests.recordings.test_plausibility import RADAR, room

SAMPLE = Path(generate.__file__).parents[1] / "sample"
FEW_FRAMES = 2


def still(task: MotionTask) -> MotionClip:
    """A motion model: a person who stands and moves an arm."""
    joints = waving(max(task.seconds or 1.0, 1.0) + 0.5)[..., [2, 0, 1]] / 100
    return MotionClip(joints_m=joints, fps=30.0, label=task.sentence)


def make(folder: Path) -> dict[str, Any]:
    """Writes them; their paths, by name."""
    (folder / "texts.txt").write_text("a person waves\na person stands\n")
    (folder / "with_nobody.txt").write_text("a person stands\nnobody\n")
    (folder / "nothing").mkdir()
    _motions(folder)
    for name, config in (("radar", RADAR), ("two_loops", replace(AWR1843, num_loops=2))):
        (folder / f"{name}.json").write_text(config.to_json())
    for order in ("iq", "qi", "interleaved"):
        write_bin(folder / f"{order}.bin", room(RADAR, FEW_FRAMES), iq_order=order, counts_per_unit=1.0)
    (folder / "made.cfg").write_text(CFG)
    (folder / "best_range.cfg").write_text(BEST_RANGE)
    (folder / "sub_frames.cfg").write_text(SUB_FRAMES)
    (folder / "other_device.cfg").write_text(CFG.replace("adcCfg 2 1", "adcCfg 2 1\nchirpComnCfg 1 2 3"))
    (folder / "points.csv").write_text("Frame,X,Y,Z,Doppler\n0,0.1,2.0,0.0,0.1\n1,0.1,2.0,0.0,0.1\n")
    (folder / "points_log.txt").write_text((folder / "points.csv").read_text())
    np.save(folder / "samples.npy", room(RADAR, FEW_FRAMES).samples)
    np.save(folder / "mmmesh.npy", np.ones((2, 3, 4, 128, 256), np.complex64))
    (folder / "activities.toml").write_text(
        '[activities]\nwaving = ["a person waves"]\nstanding = ["a person stands"]\n'
    )
    (folder / "jumping.toml").write_text('[activities]\njumping = ["a person jumps"]\nwalking = ["a person walks"]\n')
    (folder / "task.toml").write_text("")
    (folder / "own_room").mkdir()
    for name in ("depth.png", "camera.json"):
        shutil.copy(SAMPLE / name, folder / "own_room" / name)
    with Image.open(SAMPLE / "rgb.webp") as picture:
        picture.save(folder / "own_room" / "rgb.png")
    made = {path.stem: path for path in folder.iterdir()} | {"walk": _result(folder / "walk")}
    for name, words in (
        ("processed", "process {iq} --radar {radar} --no-pictures --no-analysis --out {folder}/processed"),
        ("packed.mmwl", "compress {iq} --radar {radar} --quality lossless -o {folder}/packed.mmwl"),
    ):
        assert main([word.format(folder=folder, **made) for word in (words + " --quiet").split()]) == 0
        made[Path(name).stem] = folder / name
    return made | {
        "rgb": SAMPLE / "rgb.webp", "depth": SAMPLE / "depth.png", "camera": SAMPLE / "camera.json",
        "model": f"{__name__}:{still.__name__}",
        "weights": SAMPLE.parent / "weights" / "weaver.safetensors", "results": _results(folder / "results"),
        **{name: folder / name for name in ("mesh", "scan", "views", "capture")},
    }  # fmt: skip


def _motions(folder: Path) -> None:
    joints = waving()  # centimetres, y up
    np.save(folder / "motion.npy", joints)
    np.savez(folder / "clip.npz", joints=joints[..., [2, 0, 1]] / 100, fps=np.float32(30))
    np.save(folder / "giant.npy", 0.05 * joints)
    np.save(folder / "leaning.npy", joints @ np.array([[1, 1, 0], [-1, 1, 0], [0, 0, np.sqrt(2)]]) / np.sqrt(2))
    ours = (
        "pelvis", "left_hip", "left_knee", "left_ankle", "left_foot", "right_hip", "right_knee", "right_ankle",
        "right_foot", "spine1", "spine2", "neck", "head", "left_shoulder", "left_elbow", "left_wrist",
        "right_shoulder", "right_elbow", "right_wrist",
    )  # fmt: skip
    cmu = np.zeros((len(joints), 38, 3), np.float32)
    cmu[:, list(CMU_NAMES)] = joints[:, [JOINT_NAMES.index(name) for name in ours]] / 100
    lengths = np.array([10, len(joints) - 10])
    np.savez(
        folder / "several.npz", names=np.array(["walk", "run"]), lengths=lengths, pos=cmu, parents=np.zeros(38, int)
    )
    track = np.linspace(0, 600, len(joints))[:, None, None] * np.array([1.0, 0.0, 0.0])
    np.save(folder / "far.npy", (joints + track) / 100)


def _result(folder: Path) -> Path:
    """A folder of mmweaver generate, samples included."""
    with signals_made_once():
        words = ["generate", "--demo", "--text", "a person waves", "--frames", "2", "--bin", "--no-pictures", "--quiet"]
        assert main([*words, "--out", str(folder)]) == 0
    return folder


def _results(folder: Path) -> Path:
    """A folder of mmweaver generate --texts."""
    texts = folder.with_name("texts.txt")
    with signals_made_once():
        words = ["generate", "--demo", "--frames", "1", "--no-pictures", "--quiet", "--texts", str(texts)]
        assert main([*words, "--out", str(folder)]) == 0
    return folder


@dataclass
class DepthProcessor:
    """The processor of a depth model: "blind" sees nothing, "broken" refuses every picture."""

    source: str

    def __call__(self, **_: Any) -> dict[str, Any]:
        if self.source == "broken":
            raise ValueError("a picture of another size was expected")
        return {}

    def post_process_depth_estimation(self, _: Any, target_sizes: list[tuple[int, int]]) -> list[dict[str, Any]]:
        return [{"predicted_depth": torch.full(target_sizes[0], 0.0 if self.source == "blind" else 2.0)}]


def load_model(source: str, *_: Any) -> tuple[Any, Any, Any]:
    """As `load_pretrained`."""
    kind = PROMPTED if source == "prompted" else "depth_anything"
    return SimpleNamespace(model_type=kind), DepthProcessor(source), lambda **_: None


@contextmanager
def signals_made_once(*, reads_photo: bool = False) -> Iterator[None]:
    """The room is the sample room, whatever is read, all signals of a radar are the first one, and nothing is trained.

    Motions are composed. `reads_photo`: the photo that is named is read, though not reconstructed.
    """
    with pytest.MonkeyPatch.context() as patch:
        if reads_photo:
            patch.setattr("mmweaver.scene.photo.estimated_depth.load_pretrained", load_model)
            patch.setattr("mmweaver.scene.read_photo.refined_by_sam", lambda mask, *_: mask)
            patch.setattr(Weaver, "_reconstruct", lambda *_: _sample_room())
        else:
            patch.setattr(generate.Options, "read_room", _named_room)
        patch.setattr(Weaver, "carry_out", _signal)
        patch.setattr(train, "_RECIPES", dict.fromkeys(train._RECIPES, _trained))
        patch.setattr(train, "write_request", lambda *_: None)
        yield
        _made.pop("other room", None)


_made: dict[Any, Any] = {}
_RADARS = (("hupr", 0), ("hupr", 2))  # whose signals matter
_carry_out = Weaver.carry_out


_reconstruct = Weaver._reconstruct


def use_room_without(kind: str) -> None:
    """Takes the planes of a kind out of the room, up to the end of the row."""
    of_room = _sample_room()
    planes = tuple(one for one in of_room.scene.planes if one.kind != kind)
    _made["other room"] = replace(of_room, scene=replace(of_room.scene, planes=planes))


def _named_room(asked: generate.Options, _: Weaver) -> Room:
    generate._photos(asked.extra_views)
    return _sample_room()


def _sample_room() -> Room:
    if "room" not in _made:
        photo, assumptions = sample_photo()
        _made["room"] = _reconstruct(photo, assumptions, {"sample": "the bundled room"}, Stages())
    return _made.get("other room", _made["room"])


def _trained(asked: train.Options, *_: Any) -> dict[str, Any]:
    if asked.start is not None:
        train._start(asked.start)
    for folder in asked.recordings or ():
        read_capture(folder, rgb=asked.rgb, depth=asked.depth, camera=asked.camera)
    return {"weights": "out", "steps": 0, "validation_loss": 0.0}


def _composed(request: ParsedRequest, of_room: Room) -> tuple[Motion, ...]:
    """Motions of equal requests in equal rooms are composed once."""
    if request.motion is not None:
        return compose_request(request, of_room.scene)
    key = repr((request, of_room.scene.landmarks, len(of_room.scene.planes)))
    if key not in _made:
        _made[key] = compose_request(request, of_room.scene)
    return _made[key]


def _signal(weaver: Weaver, request: ParsedRequest, of_room: Room, people: Any = None) -> Generation:
    people = _composed(request, of_room) if people is None else people
    made = request.config.name, len(request.radar_poses)
    made = made if made in _RADARS else ("awr1843", 0)
    if made not in _made:
        _made[made] = _carry_out(weaver, replace(request, keep_adc=True), of_room, people)
    if request.radar_poses:
        return _made[made]
    board = weaver.board_of(request, of_room)[0].meta()
    meta = _made[made].meta | {"text": request.text or people[0].plan.text, "board": board} | request.meta()
    return replace(_made[made], meta=meta)
