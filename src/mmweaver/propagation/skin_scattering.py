"""How skin and clothes return a wave: large smooth surfaces that are wrinkled, with a little that is diffuse.

A trunk or a limb is smooth against 4 mm and gives its echo where it faces the radar. Wrinkles tilt the surface by some
degrees, which widens the specular reflection to a lobe (the geometric-optics limit of Kirchhoff's approximation);
fibres and edges return a weak part whatever the angle (Lambert). Reference: docs/radar_primer.md, section 4.
"""

import math
from dataclasses import dataclass

import numpy as np

# Skin returns -4.6 dB (permittivity 6.6 - 9.1j at 77 GHz); cloth and what comes back in the other polarisation take
# some 4 dB more. Averaged over aspects this gives -7.5 dBsm, the lower end of what is published for people at 77 GHz.
REFLECTIVITY = 0.14
SLOPE = 0.10  # rms tilt of the surface along one direction, as a tangent: 6 degrees
ALBEDO = 0.01  # of the diffuse part
ARMS_DB = 2.0  # bare hands, often bare forearms: skin without cloth returns 4 dB more
LEGS_DB = -6.0  # read off recordings; why legs return so little is not known
NEVER_SEEN_COS = 0.02  # of skin so nearly edge-on


@dataclass(frozen=True, kw_only=True)
class SkinEcho:
    """Cross section of a piece of skin, square metres a square metre, by where its normal points.

    `slope` is the rms slope of its wrinkles along one direction. The lobe returns `reflectivity` of the power over all
    directions, the diffuse part 4 albedo cos(in) cos(out). `arms_db` and `legs_db` make these brighter or fainter than
    the rest (thighs, shins, feet).
    """

    reflectivity: float = REFLECTIVITY
    slope: float = SLOPE
    albedo: float = ALBEDO
    arms_db: float = ARMS_DB
    legs_db: float = LEGS_DB

    @property
    def least_cos(self) -> float:
        """Skin turned further away than this returns under -60 dB of what facing skin does, and is left out."""
        if self.albedo > 0:
            return NEVER_SEEN_COS
        return max(1 / math.sqrt(1 + 2 * self.slope**2 * math.log(1e6)), NEVER_SEEN_COS)

    def monostatic(self, cos: np.ndarray) -> np.ndarray:
        """Straight back where the wave comes in under an angle of this cosine."""
        return self.bistatic(cos, cos, cos)

    def bistatic(self, cos_in: np.ndarray, cos_out: np.ndarray, cos_half: np.ndarray) -> np.ndarray:
        """From one direction to another, 0 where a cosine is 0 or less.

        Reciprocal: the two directions are interchangeable.

        Args:
            cos_in: between the normal and the one direction.
            cos_out: between the normal and the other.
            cos_half: between the normal and the direction half way between both.
        """
        secant2 = 1 / np.clip(cos_half, 1e-3, 1.0) ** 2
        narrow = 1 / (2 * self.slope**2)
        lobe = self.reflectivity * narrow * secant2**2 * np.exp(narrow * (1 - secant2))
        lit = (cos_in > 0) & (cos_out > 0)
        return np.where(lit, lobe + 4 * self.albedo * cos_in * cos_out, 0.0)


# What the project took until it met recordings.
LAMBERT = SkinEcho(reflectivity=0.0, albedo=0.18, arms_db=0.0, legs_db=0.0)
