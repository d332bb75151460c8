"""Sentences for the five activities of the RadHAR recordings, and the radar that recorded them."""

from mmweaver.core.firmware_settings import FIRMWARE
from mmweaver.core.presets import IWR1443_RADHAR
from mmweaver.recognition.generated_windows import GenerationRecipe

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
        "a person walks slowly back and forth", "a person walks back and forth", "a person walks slowly back and forth",
        "a person walks slowly towards the radar, turns around, walks slowly away, turns around and walks slowly"
        " towards the radar",
        "a person walks towards the radar, turns around, walks away, turns around and walks towards the radar",
        "a person walks slowly away, turns around and walks slowly towards the radar, turns around and walks slowly"
        " away",
        "a person walks away, turns around and walks towards the radar",
        "a person walks slowly away, stands, turns around and walks slowly towards the radar",
        "a person walks slowly away", "a person walks slowly towards the radar",
    ),
}  # fmt: skip

# How people moved in the inspected recordings, where the motion library differs.
HABITS = {
    "boxing": {"roam_mps": (0.0, 0.35), "vigour": (0.8, 1.5), "tempo": (0.8, 1.6)},  # they step to and fro
    "jack": {"vigour": (0.75, 1.3)},
    "jump": {"vigour": (0.65, 1.3), "roam_mps": (0.0, 0.1)},  # hops do not end where they began
    "squats": {"vigour": (0.4, 0.95), "tempo": (0.65, 1.4)},  # slow, and seldom deep
}


def radhar_recipe() -> GenerationRecipe:
    """The IWR1443 at 30 frames a second and its five activities."""
    return GenerationRecipe(
        activities=ACTIVITIES, radar=IWR1443_RADHAR, firmware=FIRMWARE["iwr1443_radhar"], habits=HABITS
    )
