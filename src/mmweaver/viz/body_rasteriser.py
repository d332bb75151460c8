"""Rasterises a shaded body of capsules in numpy: coverage, brightness and depth of pixels.

A capsule appears as the discs of all spheres along its axis. A pixel takes depth and normal of the sphere that is
nearest to it in the picture; a depth buffer decides between capsules. The body has a face, without which nodding,
shaking or turning the head would be invisible.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.body_capsules import pose_capsules, radii_m, scale_of, widths_per_depth
from mmweaver.core.records import PoseSequence
from mmweaver.core.skeleton import joint

Array = np.ndarray
LIGHT = np.array([-0.45, -0.62, 0.64])  # unit vector to the light: from the left, above and behind the viewer
REST_TILT_RAD = float(np.arctan2(0.016, 0.052))  # of the head joint in front of the neck joint, upright
MAX_YAW_RAD, MAX_PITCH_RAD = 1.4, 1.0  # of the head
# Face and nose at reference height, in the head's frame (ahead, up from the head joint), and their radii.
_FACE_M = np.array([[(0.042, 0.015), (0.042, 0.1)], [(0.1, 0.075), (0.135, 0.045)]])
_FACE_RADIUS_M = np.array([(0.066, 0.072), (0.014, 0.02)])
FACE_COUNT = len(_FACE_M)  # of the capsules
AMBIENT = 0.46  # brightness at grazing light; surfaces turned away are darker


@dataclass(frozen=True, kw_only=True)
class Body:
    """Axes and thickness of one person's capsules at one time, in the coordinates of the joints."""

    ends_m: Float[Array, "capsule 2 3"]
    radius_m: Float[Array, "capsule 2"]  # half the depth of the cross-section
    wide: Float[Array, "capsule 3"]  # unit vector along which the cross-section is wider
    width_per_depth: Float[Array, " capsule"]


@dataclass(frozen=True, kw_only=True)
class CapsulesInPicture:
    """A body's capsules as projected by a camera; the last two axes of `ends_px` are the end and (column, row)."""

    ends_px: Float[Array, "capsule 2 2"]
    depth_m: Float[Array, "capsule 2"]
    radius_px: Float[Array, "capsule 2"]
    radius_m: Float[Array, "capsule 2"]  # distance of the surface from the axis towards the viewer


@dataclass(frozen=True, kw_only=True)
class BodyPixels:
    """The smallest part of a picture that contains a body."""

    rows: slice
    columns: slice
    cover: Float[Array, "row column"]  # share of the pixel that the body covers
    depth_m: Float[Array, "row column"]  # inf where it covers nothing
    light: Float[Array, "row column"]  # brightness, 0 to 1
    capsule: Int[Array, "row column"]  # index of the visible capsule


def bodies_of(pose: PoseSequence, instants: Int[Array, " instant"]) -> list[Body]:
    """Bodies of a person.

    Args:
        pose: The motion.
        instants: Indices (instant,) of its times.

    Returns:
        One body per instant: its capsules, then those of the face.
    """
    posed = pose_capsules(pose.joints_m[instants], pose.height_m)
    ends_m = np.stack([posed.start_m, posed.start_m + posed.axis_m], axis=2)
    face_m, face_radius_m = face_capsules(pose.joints_m[instants], pose.height_m)
    ends_m = np.concatenate([ends_m, face_m], axis=1)
    radius_m = np.concatenate([radii_m(pose.height_m, pose.girth), face_radius_m])
    wider = np.append(widths_per_depth(), np.ones(FACE_COUNT))
    wide = np.concatenate([posed.rotation[..., 0], np.repeat(posed.rotation[:, :1, :, 0], FACE_COUNT, axis=1)], axis=1)
    return [
        Body(ends_m=ends, radius_m=radius_m, wide=own, width_per_depth=wider)
        for ends, own in zip(ends_m, wide, strict=True)
    ]


def seen_width(
    along_px: Float[Array, "capsule 2"], wide_px: Float[Array, "capsule 2"], width_per_depth: Float[Array, " capsule"]
) -> Float[Array, " capsule"]:
    """Half the width of elliptic cross-sections in the picture, relative to the radius.

    Args:
        along_px: Direction (capsule, 2) of the axes in the picture.
        wide_px: Projection (capsule, 2) of the unit vector along which a cross-section is wider, at the picture's
            scale.
        width_per_depth: Width over depth (capsule,) of the cross-sections.
    """
    length = np.maximum(np.hypot(*along_px.T), 1e-9)
    across = (wide_px[:, 1] * along_px[:, 0] - wide_px[:, 0] * along_px[:, 1]) / length
    return np.sqrt(1.0 + (width_per_depth**2 - 1.0) * np.clip(across**2, 0.0, 1.0))


def rasterise(body: CapsulesInPicture, size: tuple[int, int]) -> BodyPixels | None:
    """The pixels that a body covers.

    Args:
        body: The projected capsules.
        size: Rows and columns of the picture.

    Returns:
        The covered part of the picture; None where the body is outside.
    """
    low = np.floor((body.ends_px - body.radius_px[:, :, None]).min(axis=1)).astype(int)
    high = np.ceil((body.ends_px + body.radius_px[:, :, None]).max(axis=1)).astype(int) + 1
    last = np.array([size[1], size[0]])
    low, high = np.clip(low, 0, last), np.clip(high, 0, last)
    drawn = np.flatnonzero((high > low).all(axis=1))
    if not len(drawn):
        return None
    left, top = low[drawn].min(axis=0)
    right, bottom = high[drawn].max(axis=0)
    shape = (bottom - top, right - left)
    cover, light = np.zeros(shape, np.float32), np.zeros(shape, np.float32)
    depth_m, capsule = np.full(shape, np.inf, np.float32), np.zeros(shape, np.int16)
    columns, rows = np.arange(left, right, dtype=np.float32), np.arange(top, bottom, dtype=np.float32)[:, None]
    for one in drawn.tolist():
        place = (slice(low[one, 1] - top, high[one, 1] - top), slice(low[one, 0] - left, high[one, 0] - left))
        own_cover, own_depth_m, own_light = _one(body, one, columns[place[1]], rows[place[0]])
        nearer = (own_cover > 0.0) & (own_depth_m < depth_m[place])
        np.copyto(depth_m[place], own_depth_m, where=nearer)
        np.copyto(light[place], own_light, where=nearer)
        np.copyto(capsule[place], np.int16(one), where=nearer)
        np.maximum(cover[place], own_cover, out=cover[place])
    light = AMBIENT + (1.0 - AMBIENT) * light
    return BodyPixels(
        rows=slice(top, bottom), columns=slice(left, right), cover=cover, depth_m=depth_m, light=light, capsule=capsule
    )


def blend(picture: np.ndarray, seen: BodyPixels, colour: np.ndarray, alpha: np.ndarray | float = 1.0) -> None:
    """Paints a body into a picture, in place.

    Args:
        picture: Picture (row, column, 3), uint8.
        seen: The pixels of the body.
        colour: Colour (3,) of the body, or of each pixel, 0 to 1.
        alpha: Opacity of the body, or of each pixel.
    """
    shown = picture[seen.rows, seen.columns]
    below = shown.astype(np.float32)
    shaded = seen.light[:, :, None] * (255.0 * colour)
    shown[:] = np.rint(below + (alpha * seen.cover)[:, :, None] * (shaded - below)).astype(np.uint8)


def _one(
    body: CapsulesInPicture, one: int, columns: Float[Array, " column"], rows: Float[Array, "row 1"]
) -> tuple[Float[Array, "row column"], Float[Array, "row column"], Float[Array, "row column"]]:
    """Cover, depth and cosine to the light of one capsule in a rectangle of pixels."""
    (x, y), (x_end, y_end) = body.ends_px[one].astype(np.float32)
    dx, dy = x_end - x, y_end - y
    length = np.float32(max(dx * dx + dy * dy, 1e-6))
    share = (columns - x) * (dx / length) + (rows - y) * (dy / length)
    np.maximum(share, 0.0, out=share)
    np.minimum(share, 1.0, out=share)
    radius = _interpolated(body.radius_px[one], share)
    right = (columns - x - share * dx) / radius
    down = (rows - y - share * dy) / radius
    inside = 1.0 - right * right - down * down
    cover = np.minimum(inside * radius * np.float32(0.5) + np.float32(0.5), 1.0)  # exact to first order at the edge
    bulge = np.sqrt(np.maximum(inside, 0.0))
    depth_m = _interpolated(body.depth_m[one], share) - _interpolated(body.radius_m[one], share) * bulge
    light = right * np.float32(LIGHT[0]) + down * np.float32(LIGHT[1]) + bulge * np.float32(LIGHT[2])
    return cover, depth_m, light


def _interpolated(ends: Float[Array, "2"], share: Float[Array, "row column"]) -> Float[Array, "row column"]:
    return np.float32(ends[0]) + np.float32(ends[1] - ends[0]) * share


def face_capsules(
    joints_m: Float[np.ndarray, "time 22 3"], height_m: float
) -> tuple[Float[np.ndarray, "time 2 2 3"], Float[np.ndarray, "2 2"]]:
    """Capsules of the face and its nose.

    Args:
        joints_m: Joints (time, 22, 3) in metres.
        height_m: Body height in metres.

    Returns:
        Ends (time, 2, 2, 3) and radii (2, 2) in metres.
    """
    ahead, up = head_axes(joints_m)
    place_m = _FACE_M * scale_of(height_m)
    head = joints_m[:, None, None, joint("head")]
    ends = head + place_m[..., :1] * ahead[:, None, None] + place_m[..., 1:] * up[:, None, None]
    return ends, _FACE_RADIUS_M * scale_of(height_m)


def head_axes(
    joints_m: Float[np.ndarray, "time 22 3"],
) -> tuple[Float[np.ndarray, "time 3"], Float[np.ndarray, "time 3"]]:
    """Unit vectors (time, 3) towards the front and the crown of the head.

    The 22 joints contain no rotation of the head. But the head joint is a little in front of the neck joint, so half of
    a turn and half of a nod of the head move it relative to the chest, from which the whole rotation is estimated.

    Args:
        joints_m: Joints (time, 22, 3) in metres.
    """
    left = _unit(joints_m[:, joint("left_collar")] - joints_m[:, joint("right_collar")])
    up = (joints_m[:, joint("left_collar")] + joints_m[:, joint("right_collar")]) / 2 - joints_m[:, joint("spine3")]
    up = _unit(up - (up * left).sum(-1, keepdims=True) * left)
    ahead = np.cross(left, up)
    bone = joints_m[:, joint("head")] - joints_m[:, joint("neck")]
    x, y, z = ((bone * axis).sum(-1) for axis in (ahead, left, up))
    tilt = np.arctan2(np.hypot(x, y), z)
    clear = np.clip(tilt / REST_TILT_RAD, 0.0, 1.0) * (x > 0)  # a head above its neck does not say where it faces
    yaw = np.clip(2.0 * np.arctan2(y, np.maximum(x, 1e-9)) * clear, -MAX_YAW_RAD, MAX_YAW_RAD)[:, None]
    signed = np.where(x >= 0, tilt, -tilt)
    pitch = np.clip(2.0 * (signed - REST_TILT_RAD), -MAX_PITCH_RAD, MAX_PITCH_RAD)[:, None]
    level = np.cos(yaw) * ahead + np.sin(yaw) * left
    return np.cos(pitch) * level - np.sin(pitch) * up, np.sin(pitch) * level + np.cos(pitch) * up


def _unit(vector: Float[np.ndarray, "time 3"]) -> Float[np.ndarray, "time 3"]:
    return vector / np.maximum(np.linalg.norm(vector, axis=-1, keepdims=True), 1e-9)
