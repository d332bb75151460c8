"""Scattering by skin and clothes: large smooth, wrinkled surfaces with a small diffuse part.

A trunk or a limb is smooth compared with 4 mm and returns a specular echo where it faces the radar. Wrinkles tilt the
surface by some degrees, which widens the specular reflection to a lobe (the geometric-optics limit of the Kirchhoff
approximation); fibres and edges return a weak part at all angles (Lambert). Reference: docs/radar_primer.md, section 4.
"""

import math
from dataclasses import dataclass

import numpy as np

# Skin returns -4.6 dB (permittivity 6.6 - 9.1j at 77 GHz); cloth and depolarisation cost another 4 dB or so. Averaged
# over aspect angles this gives -7.5 dBsm, the lower end of published values for people at 77 GHz.
REFLECTIVITY = 0.14
SLOPE = 0.10  # rms tilt of the surface along one direction, as a tangent: 6 degrees
ALBEDO = 0.01  # of the diffuse part
ARMS_DB = 2.0  # bare hands, often bare forearms: skin without cloth returns 4 dB more
LEGS_DB = -6.0  # fitted to recordings; the reason for the weak return is unknown
NEVER_SEEN_COS = 0.02  # skin at more grazing incidence is ignored


@dataclass(frozen=True, kw_only=True)
class SkinEcho:
    """Normalised cross section of skin (m2 per m2) as a function of the direction of its normal.

    Attributes:
        reflectivity: Power share that the specular lobe returns over all directions.
        slope: RMS slope of the wrinkles along one direction, as a tangent.
        albedo: Albedo of the diffuse part, 4 albedo cos(in) cos(out).
        arms_db: Brightness of arms and hands relative to the trunk, in dB.
        legs_db: Brightness of thighs, shins and feet relative to the trunk, in dB.
    """

    reflectivity: float = REFLECTIVITY
    slope: float = SLOPE
    albedo: float = ALBEDO
    arms_db: float = ARMS_DB
    legs_db: float = LEGS_DB

    @property
    def least_cos(self) -> float:
        """Cosine below which skin returns less than -60 dB relative to facing skin, and is omitted."""
        if self.albedo > 0:
            return NEVER_SEEN_COS
        return max(1 / math.sqrt(1 + 2 * self.slope**2 * math.log(1e6)), NEVER_SEEN_COS)

    def monostatic(self, cos: np.ndarray) -> np.ndarray:
        """Normalised monostatic cross section (...) at a cosine (...) of incidence."""
        return self.bistatic(cos, cos, cos)

    def bistatic(self, cos_in: np.ndarray, cos_out: np.ndarray, cos_half: np.ndarray) -> np.ndarray:
        """Normalised bistatic cross section, 0 where a cosine is not positive.

        Reciprocal: transmit and receive directions are interchangeable.

        Args:
            cos_in: Cosine (...) between the normal and the incident direction.
            cos_out: Cosine (...) between the normal and the scattered direction.
            cos_half: Cosine (...) between the normal and the bisector of both.

        Returns:
            Cross section (...) in m2 per m2.
        """
        secant2 = 1 / np.clip(cos_half, 1e-3, 1.0) ** 2
        narrow = 1 / (2 * self.slope**2)
        lobe = self.reflectivity * narrow * secant2**2 * np.exp(narrow * (1 - secant2))
        lit = (cos_in > 0) & (cos_out > 0)
        return np.where(lit, lobe + 4 * self.albedo * cos_in * cos_out, 0.0)


# The purely diffuse model that was used before recordings were available.
LAMBERT = SkinEcho(reflectivity=0.0, albedo=0.18, arms_db=0.0, legs_db=0.0)
