"""mmWeaver: a photo of a room and a sentence in, the I/Q signal of an FMCW MIMO radar out."""

__version__ = "0.1.0"
