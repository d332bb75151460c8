"""Physical constants (SI) and the version of the package."""

__version__ = "0.3.0"


SPEED_OF_LIGHT_MPS = 299_792_458.0
BOLTZMANN_J_PER_K = 1.380649e-23
NOISE_TEMPERATURE_K = 290.0
