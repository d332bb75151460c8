"""From Controls to joints: forward kinematics of trunk and arms, two-bone inverse kinematics of the legs.

Bones keep their lengths: a foot whose target is out of reach stops short of it.
"""

import numpy as np
from jaxtyping import Float

from mmweaver.core.shapes import Joints
from mmweaver.core.skeleton import NUM_JOINTS, joint
from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.profiles import cap, larger, rise, softmin
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions

Array = np.ndarray
Angles = Float[Array, " n"]
Frames = Float[Array, "n 3 3"]
Vectors = Float[Array, "n 3"]

LONGEST_STANCE = 0.998  # hip to ankle of a standing leg, share of its length: the knee never locks
LONGEST_LEG = 0.9995  # the same of any leg
SIDES = ("left", "right")


def rotation_x(angle: Angles) -> Frames:
    """Rotation matrices (n, 3, 3) about x by angles (n,) in radians."""
    return _about(angle, 1, 2)


def rotation_y(angle: Angles) -> Frames:
    """Rotation matrices (n, 3, 3) about y by angles (n,) in radians."""
    return _about(angle, 2, 0)


def rotation_z(angle: Angles) -> Frames:
    """Rotation matrices (n, 3, 3) about z by angles (n,) in radians."""
    return _about(angle, 0, 1)


def _about(angle: Angles, first: int, second: int) -> Frames:
    frame = np.zeros((len(angle), 3, 3))
    frame[:] = np.eye(3)
    frame[:, first, first] = frame[:, second, second] = np.cos(angle)
    frame[:, second, first] = np.sin(angle)
    frame[:, first, second] = -np.sin(angle)
    return frame


def rotated(frame: Frames, vector: Array) -> Vectors:
    """Rotates vectors.

    Args:
        frame: Rotation matrices (n, 3, 3).
        vector: One vector (3,), or one per frame (n, 3).

    Returns:
        Rotated vectors (n, 3).
    """
    if vector.ndim == 1:
        return frame @ vector
    return np.einsum("nij,nj->ni", frame, vector)


def roll_pitch_yaw(angles: Vectors) -> Frames:
    """Rotations of roll (right side down), pitch (forward) and yaw (to the left), applied in this order.

    Args:
        angles: Roll, pitch and yaw (n, 3) in radians.

    Returns:
        Rotation matrices (n, 3, 3).
    """
    return rotation_z(angles[:, 2]) @ rotation_y(angles[:, 1]) @ rotation_x(angles[:, 0])


def solve(body: SkeletonProportions, controls: Controls) -> Joints:
    """Solves the joints of a pose at every time.

    Args:
        body: Bone lengths.
        controls: Controls at n times.

    Returns:
        Joints (n, 22, 3) in metres in the floor frame (z up from the floor).
    """
    joints = np.zeros((len(controls.heading_rad), NUM_JOINTS, 3))
    pelvis_frame = rotation_z(controls.heading_rad) @ roll_pitch_yaw(controls.pelvis_rad)
    if controls.roll_over_rad.any():
        pelvis_frame = pelvis_frame @ rotation_z(controls.roll_over_rad)
    ankles = [_ankle(body, controls, side) for side in (LEFT, RIGHT)]
    joints[:, 0] = _pelvis(body, controls, pelvis_frame, ankles)
    for side in (LEFT, RIGHT):
        _place_leg(joints, body, controls, pelvis_frame, side, ankles[side])
    chest_frame = _place_trunk(joints, body, controls, pelvis_frame)
    for side in (LEFT, RIGHT):
        _place_arm(joints, body, controls, chest_frame, side)
    return joints


def chest_of(body: SkeletonProportions, controls: Controls) -> tuple[Vectors, Frames]:
    """Position and orientation of the chest.

    Args:
        body: Bone lengths.
        controls: Controls at n times.

    Returns:
        Position of spine3 (n, 3) in metres in the floor frame, and rotations (n, 3, 3) of the chest.
    """
    joints = np.zeros((len(controls.heading_rad), NUM_JOINTS, 3))
    pelvis_frame = rotation_z(controls.heading_rad) @ roll_pitch_yaw(controls.pelvis_rad)
    joints[:, 0] = _pelvis(body, controls, pelvis_frame, [_ankle(body, controls, side) for side in (LEFT, RIGHT)])
    chest_frame = _place_trunk(joints, body, controls, pelvis_frame)
    return joints[:, joint("spine3")], chest_frame


def arm_frame(arm_rad: Float[Array, "n 4"], side: int) -> Frames:
    """Rotation of the upper arm in the chest's frame.

    Args:
        arm_rad: Flexion, abduction, twist and elbow flexion (n, 4) in radians.
        side: LEFT or RIGHT.

    Returns:
        Rotation matrices (n, 3, 3).
    """
    sign = 1.0 if side == LEFT else -1.0
    flexion, abduction, twist = arm_rad[:, 0], sign * arm_rad[:, 1], sign * arm_rad[:, 2]
    return rotation_y(-flexion) @ rotation_x(abduction) @ rotation_z(twist)


def collar_frame(arm_rad: Float[Array, "n 4"], side: int) -> Frames:
    """Rotation of the collar bone, which rises with the arm, in the chest's frame.

    Args:
        arm_rad: Flexion, abduction, twist and elbow flexion (n, 4) in radians.
        side: LEFT or RIGHT.

    Returns:
        Rotation matrices (n, 3, 3).
    """
    sign = 1.0 if side == LEFT else -1.0
    share = 0.5 - 0.5 * np.cos(arm_rad[:, 0]) * np.cos(arm_rad[:, 1])  # 0 hanging, 1 overhead
    return rotation_x(sign * 0.45 * share)


def _ankle(body: SkeletonProportions, controls: Controls, side: int) -> Vectors:
    """Position of an ankle (n, 3) in metres."""
    yaw, pitch = controls.foot_rad[:, side, 0], controls.foot_rad[:, side, 1]
    return controls.foot_m[:, side] + ankle_from_foot(body, yaw, pitch)


def ankle_from_foot(body: SkeletonProportions, yaw: Angles, pitch: Angles) -> Vectors:
    """Position of the ankle: the foot pivots on its ball or, toes up, on its heel.

    Args:
        body: Bone lengths.
        yaw: Heading of the foot (n,) in radians.
        pitch: Pitch of the foot, heel up positive, (n,) in radians.

    Returns:
        The ankle (n, 3) in metres from the floor point below the ankle of the flat foot.
    """
    height, ball, heel = body.ankle_height_m, body.ball_m, body.heel_m
    on_ball = rise((pitch + 0.2) / 0.4)
    forward = on_ball * ball * (1 - np.cos(pitch)) - (1 - on_ball) * heel * (1 - np.cos(pitch)) + height * np.sin(pitch)
    up = on_ball * ball * np.sin(pitch) - (1 - on_ball) * heel * np.sin(pitch) + height * np.cos(pitch)
    return np.stack([forward * np.cos(yaw), forward * np.sin(yaw), up], axis=1)


def _pelvis(body: SkeletonProportions, controls: Controls, frame: Frames, ankles: list[Vectors]) -> Vectors:
    """The requested pelvis (n, 3), lowered where a foot that carries weight would be out of reach."""
    pelvis = controls.pelvis_m.copy()
    limits = [pelvis[:, 2]]
    longest = (LONGEST_STANCE - 0.012 * controls.knee_room) * body.leg_m
    for side in (LEFT, RIGHT):
        hip = rotated(frame, body.offset_m[joint(f"{SIDES[side]}_hip")])
        across = np.sum((pelvis[:, :2] + hip[:, :2] - ankles[side][:, :2]) ** 2, axis=1)
        height = np.sqrt(larger(longest**2 - across, (0.3 * longest) ** 2, (0.18 * longest) ** 2))
        limits.append(ankles[side][:, 2] + height - hip[:, 2] + 0.2 * (1 - controls.contact[:, side]))
    pelvis[:, 2] = softmin(limits, 0.003 + 0.01 * controls.knee_room)
    return pelvis


def _place_leg(
    joints: Joints, body: SkeletonProportions, controls: Controls, frame: Frames, side: int, ankle: Vectors
) -> None:
    name = SIDES[side]
    hip = joints[:, 0] + rotated(frame, body.offset_m[joint(f"{name}_hip")])
    away = ankle - hip
    distance = np.linalg.norm(away, axis=1)
    direction = away / distance[:, None]
    # A swinging leg is not fully extended, so that the knee does not snap.
    loose = 1 - (controls.contact[:, side] * (1 - controls.knee_room)) ** 3
    reach = cap(distance, (LONGEST_LEG - 0.0015 * loose) * body.leg_m, (0.0012 + 0.05 * loose) * body.leg_m)
    along = (body.thigh_m**2 - body.shank_m**2 + reach**2) / (2 * reach)
    aside = np.sqrt(body.thigh_m**2 - along**2)
    knee = hip + along[:, None] * direction + aside[:, None] * _knee_direction(controls, side, direction)
    ankle = hip + reach[:, None] * direction
    yaw, pitch = controls.foot_rad[:, side, 0], controls.foot_rad[:, side, 1]
    foot_frame = rotation_z(yaw) @ rotation_y(pitch)
    joints[:, joint(f"{name}_hip")] = hip
    joints[:, joint(f"{name}_knee")] = knee
    joints[:, joint(f"{name}_ankle")] = ankle
    joints[:, joint(f"{name}_foot")] = ankle + rotated(foot_frame, body.offset_m[joint(f"{name}_foot")])


def _knee_direction(controls: Controls, side: int, leg: Vectors) -> Vectors:
    """Unit vectors (n, 3) perpendicular to the leg: between the directions of foot and pelvis, rotated outward."""
    outward = controls.knee_out_rad[:, side] * (1.0 if side == LEFT else -1.0)
    foot, pelvis = controls.foot_rad[:, side, 0], controls.heading_rad + controls.pelvis_rad[:, 2]
    yaw = 0.5 * (foot + pelvis) + outward
    level, up = np.cos(controls.knee_up_rad), np.sin(controls.knee_up_rad)
    ahead = np.stack([level * np.cos(yaw), level * np.sin(yaw), up], axis=1)
    square = ahead - np.sum(ahead * leg, axis=1, keepdims=True) * leg
    return square / np.linalg.norm(square, axis=1, keepdims=True)


def _place_trunk(joints: Joints, body: SkeletonProportions, controls: Controls, frame: Frames) -> Frames:
    """Places spine, neck and head; returns the chest's rotation (that of spine3), (n, 3, 3)."""
    third = roll_pitch_yaw(controls.spine_rad / 3)
    place = joints[:, 0]
    for name in ("spine1", "spine2", "spine3"):
        place = place + rotated(frame, body.offset_m[joint(name)])
        joints[:, joint(name)] = place
        frame = frame @ third
    half = rotation_z(controls.head_rad[:, 1] / 2) @ rotation_y(controls.head_rad[:, 0] / 2)
    neck = place + rotated(frame, body.offset_m[joint("neck")])
    joints[:, joint("neck")] = neck
    joints[:, joint("head")] = neck + rotated(frame @ half, body.offset_m[joint("head")])
    return frame


def _place_arm(joints: Joints, body: SkeletonProportions, controls: Controls, chest: Frames, side: int) -> None:
    name, arm = SIDES[side], controls.arm_rad[:, side]
    collar = joints[:, joint("spine3")] + rotated(chest, body.offset_m[joint(f"{name}_collar")])
    shoulder = collar + rotated(chest @ collar_frame(arm, side), body.offset_m[joint(f"{name}_shoulder")])
    upper = chest @ arm_frame(arm, side)
    elbow = shoulder + rotated(upper, body.offset_m[joint(f"{name}_elbow")])
    lower = upper @ rotation_y(-arm[:, 3])
    joints[:, joint(f"{name}_collar")] = collar
    joints[:, joint(f"{name}_shoulder")] = shoulder
    joints[:, joint(f"{name}_elbow")] = elbow
    joints[:, joint(f"{name}_wrist")] = elbow + rotated(lower, body.offset_m[joint(f"{name}_wrist")])
