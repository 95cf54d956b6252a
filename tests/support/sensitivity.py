"""How much a mechanism's output depends on its frame's lifts, to first order."""

import numpy as np

from kin.numeric.elementary import Jet


def sensitivity(mechanism, theta):
    """Change of the output per change of S and of S1 (2, n), rad/mm or 1, at relative angles, the shaft held."""
    theta = np.atleast_1d(np.asarray(theta, dtype=float))
    at = mechanism.at(theta, 1)
    found = []
    for rates in ((1.0, 0.0), (0.0, 1.0)):
        s, s1 = (Jet(np.stack([lift, np.full_like(lift, k)])) for lift, k in zip(at.faces[:, 0], rates, strict=True))
        frame, output = mechanism.driven(s, s1)
        # the cam turns on in the frame by what the frame has turned
        found.append(output.c[1] + at.output[1] * frame.c[1] / at.shaft[1])
    return np.stack(found)
