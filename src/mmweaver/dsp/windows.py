"""Windows for FFTs."""

import numpy as np
from jaxtyping import Float


def hann(num: int) -> Float[np.ndarray, " num"]:
    """The periodic Hann window, 0.5 - 0.5 cos(2 pi n / num): its spectrum is three bins, 1 and twice -1/2.

    >>> hann(4).round(12).tolist()
    [0.0, 0.5, 1.0, 0.5]
    >>> hann(1).tolist()
    [1.0]
    """
    if num == 1:
        return np.ones(1)
    return 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(num) / num)
