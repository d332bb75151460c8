"""What walls and furniture are made of, and how much of a wave they throw back.

Reference: ITU-R P.2040-3, table 3 (permittivity, equation 28) and equations 31, 37 (half space and slab).
"""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.registry import Registry
from mmweaver.core.shapes import Values


@dataclass(frozen=True, kw_only=True)
class Material:
    """epsilon = a f^b, sigma = c f^d with f in GHz; a slab so thick, rough in the sense of effective roughness."""

    name: str
    a: float
    b: float
    c: float
    d: float
    thickness_m: float
    scattering: float  # share of the reflected amplitude that is diffuse (S of the effective-roughness model)


# Thickness and scattering are choices of this project, not of the standard. P.2040 gives brick up to 40 GHz, marble
# up to 60, plywood up to 40: their laws are carried on to 77. Fabric (upholstery) is not in the standard: foam and
# cloth, after wood with a lower density.
MATERIALS: Registry[Material] = Registry(
    "material",
    [
        (m.name, m)
        for m in (
            Material(name="concrete", a=5.24, b=0.0, c=0.0462, d=0.7822, thickness_m=0.20, scattering=0.35),
            Material(name="brick", a=3.91, b=0.0, c=0.0238, d=0.16, thickness_m=0.12, scattering=0.45),
            Material(name="plasterboard", a=2.73, b=0.0, c=0.0085, d=0.9395, thickness_m=0.0125, scattering=0.25),
            Material(name="wood", a=1.99, b=0.0, c=0.0047, d=1.0718, thickness_m=0.03, scattering=0.35),
            Material(name="glass", a=6.31, b=0.0, c=0.0036, d=1.3394, thickness_m=0.006, scattering=0.10),
            Material(name="ceiling_board", a=1.48, b=0.0, c=0.0011, d=1.0750, thickness_m=0.0095, scattering=0.35),
            Material(name="chipboard", a=2.58, b=0.0, c=0.0217, d=0.7800, thickness_m=0.018, scattering=0.30),
            Material(name="plywood", a=2.71, b=0.0, c=0.33, d=0.0, thickness_m=0.012, scattering=0.30),
            Material(name="marble", a=7.074, b=0.0, c=0.0055, d=0.9262, thickness_m=0.02, scattering=0.15),
            Material(name="floorboard", a=3.66, b=0.0, c=0.0044, d=1.3515, thickness_m=0.02, scattering=0.30),
            Material(name="metal", a=1.0, b=0.0, c=1.0e7, d=0.0, thickness_m=0.002, scattering=0.15),
            Material(name="fabric", a=1.4, b=0.0, c=0.0040, d=1.0, thickness_m=0.08, scattering=0.60),
        )
    ],
)


def relative_permittivity(material: Material, frequency_hz: float) -> complex:
    """Complex relative permittivity, eps' - j 17.98 sigma / f (f in GHz).

    >>> eps = relative_permittivity(MATERIALS["glass"], 79e9)
    >>> round(eps.real, 2), round(eps.imag, 2)
    (6.31, -0.29)
    """
    f_ghz = frequency_hz / 1e9
    return complex(material.a * f_ghz**material.b, -17.98 * material.c * f_ghz**material.d / f_ghz)


def reflection(material: Material, cos_incidence: Values, frequency_hz: float, *, polarisation: str = "te") -> Values:
    """Complex reflection coefficient of a slab at each angle of incidence (its cosine, in [0, 1]).

    `te`: the electric field is parallel to the face (a vertically polarised radar and a wall); `tm`: it lies in the
    plane of incidence (the same radar and the floor).

    Reference: ITU-R P.2040-3, equations 31a, 31b and 37a, 37c.
    """
    eps = relative_permittivity(material, frequency_hz)
    cos_i = np.clip(np.asarray(cos_incidence, float), 0.0, 1.0)
    root = np.sqrt(eps - (1 - cos_i**2) + 0j)
    if polarisation == "te":
        face = (cos_i - root) / (cos_i + root)
    elif polarisation == "tm":
        face = (eps * cos_i - root) / (eps * cos_i + root)
    else:
        raise ValueError(f"polarisation {polarisation!r}: te or tm")
    q = 2 * np.pi * material.thickness_m * frequency_hz / SPEED_OF_LIGHT_MPS * root
    through = np.exp(-2j * q)
    return face * (1 - through) / (1 - face**2 * through)
