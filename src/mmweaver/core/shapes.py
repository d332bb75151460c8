"""Array shape aliases, checked at run time in every test (jaxtyping and beartype)."""

import numpy as np
from jaxtyping import Bool, Complex, Float, Int, UInt8

Array = np.ndarray
Values = np.ndarray | np.number  # any shape, including scalars

# one axis
PerFrame = Float[Array, " frame"]
PerRange = Float[Array, " range"]
PerDoppler = Float[Array, " doppler"]
PerIndex = Int[Array, "_"]  # any number of indices
# vectors
Vec3 = Float[Array, "3"]
Rotation = Float[Array, "3 3"]
Points = Float[Array, "point 3"]
PerPoint = Float[Array, " point"]
AntennaPositions = Float[Array, "antenna 3"]
# signals
CubeValues = Complex[Array, "frame range doppler antenna"]
AdcValues = Complex[Array, "frame loop tx rx sample"]
LostChirps = Bool[Array, "frame loop slot"]  # whether any sample of a chirp is missing
LostShare = Float[Array, "frame loop slot"]  # share of the samples of a chirp that are missing
RangeDopplerMap = Float[Array, "frame range doppler"]
RangeDopplerMask = Bool[Array, "frame range doppler"]
RangeAngleMap = Float[Array, "frame range angle"]
PerAngle = Float[Array, " angle"]
# poses
Joints = Float[Array, "frame 22 3"]
# pictures
RgbPixels = UInt8[Array, "height width 3"]
DepthPixels = Float[Array, "height width"]
ClassPixels = UInt8[Array, "height width"]
# meshes
Vertices = Float[Array, "vertex 3"]
Faces = Int[Array, "face 3"]
PerFace = Int[Array, " face"]
GridMask = Bool[Array, "y x"]
