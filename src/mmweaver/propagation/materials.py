"""Materials of walls and furniture, with their reflection and transmission coefficients.

Reference: ITU-R P.2040-3, table 3 (permittivity, equation 28) and equations 31, 37 (half space and slab).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.registry import Registry
from mmweaver.core.shapes import Values

MIN_ECHO_SHARE = 0.01  # amplitude relative to the strongest echo below which an echo is negligible


@dataclass(frozen=True, kw_only=True)
class Material:
    """A slab of a material with epsilon = a f^b and sigma = c f^d, f in GHz (ITU-R P.2040-3, equation 28)."""

    name: str
    a: float
    b: float
    c: float
    d: float
    thickness_m: float
    scattering: float  # share of the reflected amplitude that is diffuse (S of the effective-roughness model)
    roughness_m: float = 0.0  # rms height of what is finer than a wavelength

    def fine_loss(self, cos_incidence: Values, frequency_hz: float) -> Values:
        """Share of the specular power that fine roughness scatters.

        Reference: Ament, "Toward a theory of reflection by a rough surface", 1953.

        Args:
            cos_incidence: Cosine (...) of the angle of incidence.
            frequency_hz: Frequency in Hz.

        Returns:
            Share (...) from 0 to 1.
        """
        turn = 4 * np.pi * self.roughness_m * frequency_hz / SPEED_OF_LIGHT_MPS * np.asarray(cos_incidence)
        return 1 - np.exp(-(turn**2))


# Thickness and scattering are choices of this project, not of the standard. P.2040 gives brick up to 40 GHz, marble
# up to 60, plywood up to 40: their laws are extrapolated to 77. Fabric (upholstery) is not in the standard: foam and
# cloth, derived from wood with a lower density. Roughness is that of plaster (0.05 and 0.15 mm on two samples, ingrain
# wallpaper 0.13 mm), assumed on concrete, brick, plasterboard and ceilings: Piesiewicz et al., "Scattering analysis
# for the modeling of THz communication systems", IEEE Trans. Antennas Propag. 55(11), 2007, table I.
MATERIALS: Registry[Material] = Registry(
    "material",
    [
        (name, Material(name=name, a=a, b=b, c=c, d=d, thickness_m=thick, scattering=diffuse, roughness_m=rough))
        for name, a, b, c, d, thick, diffuse, rough in (
            ("concrete", 5.24, 0.0, 0.0462, 0.7822, 0.20, 0.35, 0.15e-3),
            ("brick", 3.91, 0.0, 0.0238, 0.16, 0.12, 0.45, 0.15e-3),
            ("plasterboard", 2.73, 0.0, 0.0085, 0.9395, 0.0125, 0.25, 0.15e-3),
            ("wood", 1.99, 0.0, 0.0047, 1.0718, 0.03, 0.35, 0.0),
            ("glass", 6.31, 0.0, 0.0036, 1.3394, 0.006, 0.10, 0.0),
            ("ceiling_board", 1.48, 0.0, 0.0011, 1.0750, 0.0095, 0.35, 0.15e-3),
            ("chipboard", 2.58, 0.0, 0.0217, 0.7800, 0.018, 0.30, 0.0),
            ("plywood", 2.71, 0.0, 0.33, 0.0, 0.012, 0.30, 0.0),
            ("marble", 7.074, 0.0, 0.0055, 0.9262, 0.02, 0.15, 0.0),
            ("floorboard", 3.66, 0.0, 0.0044, 1.3515, 0.02, 0.30, 0.0),
            ("metal", 1.0, 0.0, 1.0e7, 0.0, 0.002, 0.15, 0.0),
            ("fabric", 1.4, 0.0, 0.0040, 1.0, 0.08, 0.60, 0.0),
        )
    ],
)


def relative_permittivity(material: Material, frequency_hz: float) -> complex:
    """Complex relative permittivity, eps' - j 17.98 sigma / f (f in GHz).

    Args:
        material: The material.
        frequency_hz: Frequency in Hz.

    >>> eps = relative_permittivity(MATERIALS["glass"], 79e9)
    >>> round(eps.real, 2), round(eps.imag, 2)
    (6.31, -0.29)
    """
    f_ghz = frequency_hz / 1e9
    return complex(material.a * f_ghz**material.b, -17.98 * material.c * f_ghz**material.d / f_ghz)


def reflection(material: Material, cos_incidence: Values, frequency_hz: float, *, polarisation: str = "te") -> Values:
    """Complex reflection coefficient of a slab.

    Reference: ITU-R P.2040-3, equations 31a, 31b and 37a, 37c.

    Args:
        material: Material and thickness of the slab.
        cos_incidence: Cosine (...) of the angle of incidence, in [0, 1].
        frequency_hz: Frequency in Hz.
        polarisation: "te", the electric field parallel to the face (a vertically polarised radar and a wall), or "tm",
            the field in the plane of incidence (the same radar and the floor).

    Returns:
        Amplitude coefficient (...).
    """
    face, through, _ = _slab(material, cos_incidence, frequency_hz, polarisation)
    return face * (1 - through) / (1 - face**2 * through)


def transmission(material: Material, cos_incidence: Values, frequency_hz: float, *, polarisation: str = "te") -> Values:
    """Complex transmission coefficient of a slab, relative to free space in its place.

    Reference: ITU-R P.2040-3, equations 37b, 37d.

    Args:
        material: Material and thickness of the slab.
        cos_incidence: Cosine (...) of the angle of incidence, in [0, 1].
        frequency_hz: Frequency in Hz.
        polarisation: "te" or "tm", see `reflection`.

    Returns:
        Amplitude coefficient (...).
    """
    face, through, root = _slab(material, cos_incidence, frequency_hz, polarisation)
    cos_i = np.clip(np.asarray(cos_incidence, float), 0.0, 1.0)
    # through = exp(-2jq): the phase of the slab minus that of the same thickness of air
    air = np.exp(2j * np.pi * material.thickness_m * frequency_hz / SPEED_OF_LIGHT_MPS * cos_i)
    once = np.exp(-2j * np.pi * material.thickness_m * frequency_hz / SPEED_OF_LIGHT_MPS * root)
    return (1 - face**2) * once * air / (1 - face**2 * through)


@dataclass(frozen=True)
class SlabEchoes:
    """A slab's reflection as echoes of its front, its back and its internal reflections, the front first.

    Phases are those of a beat signal, which grow with path length: with coefficients c and lengths x the reflection
    at frequency f is sum_k c_k exp(2 pi j f x_k / c0), the complex conjugate of `reflection`.
    """

    coefficient: np.ndarray  # (echo, ...) complex
    longer_m: np.ndarray  # (echo, ...) excess path length of each echo over the front's

    def __iter__(self) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Coefficient and excess length of each echo."""
        return zip(self.coefficient, self.longer_m, strict=True)

    @property
    def doubled(self) -> "SlabEchoes":
        """Echoes of a wave that meets the slab twice at the same angle; each is a whole number of steps longer."""
        count = len(self.coefficient)
        coefficients = [
            sum(
                self.coefficient[one] * self.coefficient[order - one]
                for one in range(order + 1)
                if one < count > order - one
            )
            for order in range(2 * count - 1)
        ]
        step_m = self.longer_m[-1] / max(count - 1, 1)
        return SlabEchoes(np.array(coefficients), np.multiply.outer(np.arange(2 * count - 1), step_m))

    def value(self, frequency_hz: float) -> Values:
        """The sum (...) of the echoes at a frequency in Hz."""
        return (self.coefficient * np.exp(2j * np.pi * frequency_hz * self.longer_m / SPEED_OF_LIGHT_MPS)).sum(axis=0)

    def merged(self, frequency_hz: float) -> "SlabEchoes":
        """These echoes, fields (echo, 3) with lengths (echo,), with negligible ones added to the strongest.

        Args:
            frequency_hz: Frequency in Hz at which the sum stays exact.
        """
        field, longer_m = self.coefficient.copy(), self.longer_m
        size = np.linalg.norm(field, axis=1)
        strongest = size.argmax()
        kept = size >= MIN_ECHO_SHARE * size[strongest]
        turn = np.exp(2j * np.pi * frequency_hz * (longer_m - longer_m[strongest]) / SPEED_OF_LIGHT_MPS)
        field[strongest] += (field * turn[:, None])[~kept].sum(axis=0)
        return SlabEchoes(field[kept], longer_m[kept])


def slab_echoes(
    material: Material, cos_incidence: Values, frequency_hz: float, *, polarisation: str = "te", most: int = 4
) -> SlabEchoes:
    """A slab's reflection as a few echoes.

    Each echo is nearly flat over a radar's band, their sum is not: 12.5 mm of plasterboard reflect 0.19 to 0.28 of the
    amplitude within 3.4 GHz. A slab so lossy that nothing returns from its back has a front echo alone.

    Args:
        material: Material and thickness of the slab.
        cos_incidence: Cosine (...) of the angle of incidence.
        frequency_hz: Frequency in Hz at which the sum is exact.
        polarisation: "te" or "tm", see `reflection`.
        most: Maximum number of echoes; the last one contains all later ones.

    Returns:
        Echoes (echo, ...).
    """
    face, through, root = (np.conj(part) for part in _slab(material, cos_incidence, frequency_hz, polarisation))
    longer_m = 2 * material.thickness_m * root.real
    carrier = np.exp(2j * np.pi * frequency_hz * longer_m / SPEED_OF_LIGHT_MPS)
    again = through / carrier  # attenuation of one round trip through the slab
    coefficients = [face]
    for order in range(1, most):
        coefficients.append(-face * (1 - face**2) * face ** (2 * order - 2) * again**order)
    coefficients[-1] = coefficients[-1] / (1 - face**2 * through)
    if most == 1 or np.all(np.abs(coefficients[1]) < MIN_ECHO_SHARE * np.abs(face)):
        return SlabEchoes((face * (1 - through) / (1 - face**2 * through))[None], np.zeros_like(longer_m)[None])
    return SlabEchoes(np.array(coefficients), np.arange(most).reshape(-1, *[1] * longer_m.ndim) * longer_m)


def mean_reflectivity(
    material: Material, cos_incidence: Values, frequencies_hz: np.ndarray, polarisation: str
) -> Values:
    """Mean of |reflection|^2 over frequencies: the reflectivity that applies to scattering by a rough face.

    Args:
        material: Material and thickness of the slab.
        cos_incidence: Cosine (...) of the angle of incidence.
        frequencies_hz: Frequencies in Hz.
        polarisation: "te" or "tm", see `reflection`.

    Returns:
        Power share (...).
    """
    each = [reflection(material, cos_incidence, one, polarisation=polarisation) for one in frequencies_hz]
    return np.mean(np.abs(each) ** 2, axis=0)


def _slab(
    material: Material, cos_incidence: Values, frequency_hz: float, polarisation: str
) -> tuple[Values, Values, Values]:
    """Reflection of one face, attenuation and phase of one round trip through the slab, and sqrt(eps - sin^2)."""
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
    return face, np.exp(-2j * q), root
