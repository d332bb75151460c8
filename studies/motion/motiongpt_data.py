"""Motions with sentences, as HumanML3D features: the library's twelve activities and CMU's walks, runs and jumps."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import FreeSpace, PoseSequence, Scene
from mmweaver.core.seeding import stream
from mmweaver.motion.compose import compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.mocap.clip import MotionClip, low_passed
from mmweaver.motion.mocap.joint_arrays import FPS, clips_of
from mmweaver.motion.mocap.read_motion import read_motion
from studies.motion.humanml3d_features import features_from_joints, y_up
from studies.physics.empty_room_cube import empty_room

Array = np.ndarray
HEIGHT_M = 1.7
FRAMES = 80  # 4 s, 20 motion tokens
CMU_FILE = Path("motion") / "cmu" / "cmu_joints_m_120fps.npz"
SUBJECTS = ("a person", "someone", "the person", "a man", "a woman", "the man", "a human")
# What is said of each activity. The last of each list is never trained on: it asks whether other words are understood.
SENTENCES: dict[str, tuple[str, ...]] = {
    "walking": ("walks", "walks forwards", "is walking", "walks slowly", "walks quickly", "walks away",
                "walks to the left", "strolls"),
    "jogging": ("jogs forwards", "is jogging to the right", "runs forwards", "jogs to the left", "runs",
                "is running forwards"),
    "jumping": ("jumps", "is jumping", "jumps twice", "jumps up and down", "hops"),
    "jumping jacks": ("does jumping jacks", "is doing jumping jacks", "performs three jumping jacks",
                      "does some jumping jacks"),
    "squatting": ("squats", "is squatting", "does squats", "does two squats", "performs squats"),
    "waving": ("waves", "waves with the left hand", "waves with the right hand", "is waving", "waves with a hand"),
    "clapping": ("claps", "is clapping", "claps the hands", "applauds", "is clapping the hands"),
    "punching": ("punches", "is punching", "throws punches", "is boxing", "boxes"),
    "left-hand raise": ("raises the left hand", "is raising the left hand", "lifts the left arm",
                        "raises the left arm"),
    "right-hand raise": ("raises the right hand", "is raising the right hand", "lifts the right arm",
                         "raises the right arm"),
    "sitting and drinking": ("sits and drinks", "is sitting and drinking", "sits drinking water",
                             "drinks while sitting"),
    "turning": ("turns around", "is turning around", "turns to the left", "turns to the right", "turns"),
}  # fmt: skip
ACTIVITIES = tuple(SENTENCES)
CMU_WORDS = {"walking": "walking", "running": "jogging", "jumping": "jumping"}


@dataclass(frozen=True, kw_only=True)
class SentenceExample:
    """One motion: features (frame, 263) and what it is."""

    features: Float[Array, "frame 263"]
    activity: str
    sentence: str
    origin: str  # library | cmu


def wide_room() -> Scene:
    """A floor of 24 x 16 m, so that no motion is cut short."""
    x, y = np.arange(-12, 12.01, 0.25), np.arange(0.0, 16.01, 0.25)
    free = np.ones((len(y), len(x)), bool)
    return replace(empty_room(floor_z_m=-1.0), free_space=FreeSpace(x_m=x, y_m=y, is_free=free, is_seen=free))


def library_examples(seeds: range, *, held_out_words: bool = False) -> Iterator[SentenceExample]:
    """One motion of each activity for each seed; with `held_out_words`, sentences that are never trained on."""
    room = wide_room()
    for seed in seeds:
        for activity in ACTIVITIES:
            sentence = sentence_of(activity, seed, held_out=held_out_words)
            try:
                motion = compose(
                    plan_motion(sentence, FRAMES / FPS + 1 / FPS), room, seed=seed, range_window_m=(0.7, 15.0),
                    height_m=HEIGHT_M,
                )  # fmt: skip
            except InputError:
                continue  # a number of jumps that needs more time
            features = features_from_joints(y_up(_at_20_hz(motion.pose)))
            yield SentenceExample(features=features, activity=activity, sentence=sentence, origin="library")


def sentence_of(activity: str, seed: int, *, held_out: bool) -> str:
    """A sentence of an activity, sampled by the seed."""
    rng = stream(seed, "motiongpt", "sentence", activity)
    phrases = SENTENCES[activity]
    phrase = phrases[-1] if held_out else phrases[int(rng.integers(len(phrases) - 1))]
    return f"{SUBJECTS[int(rng.integers(len(SUBJECTS)))]} {phrase}"


def cmu_examples(data: Path, part: str) -> Iterator[SentenceExample]:
    """Pieces of 4 s of CMU's walks, runs and jumps of one part ("train" or "test"); shorter clips are not padded."""
    path = data / CMU_FILE
    for k, name in enumerate(clips_of(path)):
        kind = name.split("/")[1].removesuffix("_extra")
        if not name.startswith(part) or kind not in CMU_WORDS:
            continue
        activity = CMU_WORDS[kind]
        clip = read_motion(path, clip=name)
        joints = _fitted(clip.scaled_to(HEIGHT_M))
        for first in range(0, max(len(joints) - FRAMES, 1), FRAMES // 2):
            piece = joints[first : first + FRAMES + 1]
            if len(piece) > 24:
                subject = SUBJECTS[(k + first) % len(SUBJECTS)]
                sentence = f"{subject} {SENTENCES[activity][0]}"
                yield SentenceExample(
                    features=features_from_joints(y_up(piece)), activity=activity, sentence=sentence, origin="cmu"
                )


def _at_20_hz(pose: PoseSequence) -> Float[Array, "frame 22 3"]:
    from scipy.interpolate import CubicSpline

    time_s = np.arange(FRAMES + 1) / FPS
    return np.asarray(CubicSpline(pose.time_s, pose.joints_m, axis=0)(time_s))


def _fitted(clip: MotionClip) -> Float[Array, "frame 22 3"]:
    """A clip at 20 frames a second."""
    from scipy.interpolate import CubicSpline

    joints = low_passed(clip)
    time_s = np.arange(len(joints)) / clip.fps
    wanted = np.arange(0, time_s[-1], 1 / FPS)
    return np.asarray(CubicSpline(time_s, joints, axis=0)(wanted))
