"""Motion of a sentence without a photo, on an empty floor in front of the radar.

Recognizes sentences of an empty scene, without a person.
"""

import re

import numpy as np

from mmweaver.core.records import CameraIntrinsics, FreeSpace, Plane, RgbdPhoto, Scene
from mmweaver.motion.compose import Motion, compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.planning.targets import drop_targets

NOBODY = "nobody"  # canonical form, used in task files, requests and meta.json
_ANYBODY = r"(?:nobody|no ?-?one|no (?:person|people|human))"
_PLACE = r"(?:room|place|scene|floor|house|kitchen|bedroom|bathroom|office|hall|corridor|(?:living|dining) room)"
_EMPTY = re.compile(
    rf"(?:there (?:is|are) |there's )?{_ANYBODY}(?: is| are)?(?: there| here| present| around)?"
    rf"(?: (?:in|inside) (?:the|this|my|it|an?)?(?: empty)? ?{_PLACE}?)?"
    rf"|(?:(?:the|this|my|an?) )?{_PLACE}(?: (?:is|stays|remains|that is))? empty"
    rf"|(?:(?:the|this|my|an) )?empty {_PLACE}(?: with {_ANYBODY}(?: in it| there)?)?"
    rf"|(?:(?:the|this|my|an?) )?{_PLACE} (?:with|without) (?:{_ANYBODY}|people|anyone|anybody|a person)(?: in it)?"
)


def says_nobody(text: str) -> bool:
    """Whether a whole sentence describes an empty scene.

    Args:
        text: The sentence.

    >>> says_nobody("nobody"), says_nobody("An empty room."), says_nobody("nobody waves")
    (True, True, False)
    """
    words = " ".join(text.lower().strip().rstrip(".!").split())
    return bool(_EMPTY.fullmatch(words))


RADAR_HEIGHT_M = 1.1
FLOOR_M = 8.0  # both ways
WINDOW_M = (0.8, 8.0)
CELL_M = 0.05
_LEVEL = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def empty_floor() -> Scene:
    """A free floor of 8 x 8 m in front of a radar 1.1 m high, all of it visible to the camera."""
    half = FLOOR_M / 2
    x, y = np.arange(-half, half + 1e-9, CELL_M), np.arange(0.0, FLOOR_M + 1e-9, CELL_M)
    free = np.ones((len(y), len(x)), dtype=bool)
    lens = CameraIntrinsics(fx=16.0, fy=16.0, cx=31.5, cy=23.5, width=64, height=48)
    photo = RgbdPhoto(rgb=np.full((48, 64, 3), 128, np.uint8), depth_m=np.full((48, 64), np.nan), intrinsics=lens)
    floor = Plane(
        kind="floor",
        centre_m=np.array([0.0, half, -RADAR_HEIGHT_M]),
        normal=np.array([0.0, 0.0, 1.0]),
        axis_u=np.array([1.0, 0.0, 0.0]),
        axis_v=np.array([0.0, 1.0, 0.0]),
        half_size_m=(half, half),
        material="concrete",
    )
    corners = np.array([[-half, 0, 0], [half, 0, 0], [half, FLOOR_M, 0], [-half, FLOOR_M, 0]]) - [0, 0, RADAR_HEIGHT_M]
    return Scene(
        photo=photo,
        radar_from_camera=_LEVEL,
        vertices_m=corners,
        faces=np.array([[0, 1, 2], [0, 2, 3]]),
        face_material=np.array([0, 0]),
        material_names=("concrete",),
        planes=(floor,),
        floor_z_m=-RADAR_HEIGHT_M,
        free_space=FreeSpace(x_m=x, y_m=y, is_free=free, is_seen=np.ones_like(free)),
        seats=(),
        assumptions=(),
    )


def act_out(
    text: str,
    *,
    duration_s: float | None = None,
    seed: int = 0,
    height_m: float | None = None,
    subject: int | None = None,
) -> Motion:
    """Composes the motion of a sentence on an empty floor, 1.1 m below the radar at the origin.

    Seats are stools, since the floor is empty, and a walk to a door leads to free floor.

    Args:
        text: The sentence.
        duration_s: Duration in seconds; None for the natural one.
        seed: Determines what the sentence leaves open.
        height_m: Height of the body in metres; None takes the described or the subject's height.
        subject: Number of the person; None samples it by the seed.

    Returns:
        The motion at 120 Hz in the radar's frame, with the plan and its assumptions.

    Raises:
        InputError: If the sentence is not understood or does not fit the duration.

    >>> motion = act_out("a person bows", duration_s=2.0)
    >>> motion.plan.steps[0].lower, motion.pose.joints_m.shape
    ('bow', (245, 22, 3))
    """
    return compose(
        drop_targets(plan_motion(text, duration_s)),  # no photo shows a door or table to walk to
        empty_floor(),
        seed=seed,
        range_window_m=WINDOW_M,
        height_m=height_m,
        subject=subject,
    )
