"""The five activities of the RadHAR recordings in words, and the board that recorded them."""

from mmweaver.core.firmware_settings import FIRMWARE
from mmweaver.core.presets import IWR1443_RADHAR
from mmweaver.tasks.generation import Recipe

ACTIVITIES = {
    "boxing": (
        "a person punches", "a person punches quickly", "a person punches with the right hand",
        "a person punches with the left hand",
    ),
    "jack": ("a person does jumping jacks", "a person does jumping jacks quickly", "jumping jacks slowly"),
    "jump": (
        "a person hops", "a person hops quickly", "a person hops slowly", "a person hops on the spot",
        "a person hops", "a person jumps",
    ),
    "squats": ("a person squats", "a person squats quickly", "a person squats slowly"),
    "walk": (
        "a person walks slowly back and forth", "a person walks back and forth",
        "a person walks slowly towards the radar", "a person walks towards the radar", "a person walks slowly away",
        "a person walks slowly towards the radar, stops, turns around and walks slowly away",
        "a person walks towards the radar, stops, turns around and walks away",
        "a person walks slowly away, stops, turns around and walks slowly towards the radar",
        "a person walks slowly away, turns around and walks slowly towards the radar",
    ),
}  # fmt: skip

ROAMING_MPS = {"boxing": (0.0, 0.3), "jump": (0.0, 0.1)}  # boxers step to and fro, hops do not end where they began


def radhar_recipe() -> Recipe:
    """The IWR1443 at 30 frames a second and its five activities."""
    return Recipe(
        activities=ACTIVITIES, radar=IWR1443_RADHAR, firmware=FIRMWARE["iwr1443_radhar"], roaming_mps=ROAMING_MPS
    )
