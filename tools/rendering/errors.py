"""The arithmetic of bench_render.py: errors of pictures against a noisy reference, errors at a
given time, ratios of two programs. Pictures are sequences of floats, three for each pixel.

A picture I and a reference R that are independent and have the same mean differ by
E (I - R)^2 = var(I) + var(R). The reference is the mean of two halves A and B with different seeds,
so E (A - B)^2 / 4 = var(R). Subtracting it leaves the error of the picture alone.
"""
import math

# Two-sided 95 % quantiles of Student's t by degrees of freedom
T95 = (math.nan, 12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26, 2.23)


def mean(values):
    return math.fsum(values) / len(values)


def half_width(values):
    """Returns the half-width of the 95 % interval of the mean; nan for a single value."""
    n = len(values)
    if n < 2:
        return math.nan
    middle = mean(values)
    variance = math.fsum((v - middle)**2 for v in values) / (n - 1)
    return t95(n - 1) * math.sqrt(variance / n)


def t95(freedom):
    return T95[freedom] if freedom < len(T95) else 1.96 + 2.6 / freedom


class Reference:
    """The mean of two halves of a long render, and its own noise in each measure."""

    def __init__(self, first, second):
        self.values = [(a + b) / 2 for a, b in zip(first, second)]
        self.weights = [1 / (r * r + 0.01) for r in self.values]
        self.noise = [e / 4 for e in self._squares(first, second)]
        self.mean = mean(self.values)
        pixels = range(0, len(self.values), 3)
        differences = (sum(first[i:i + 3]) - sum(second[i:i + 3]) for i in pixels)
        self.mean_error = math.sqrt(sum(d * d for d in differences)) / 2 / len(self.values)

    def _squares(self, one, other):
        """Returns the mean squared difference, and the mean weighted by 1 / (R^2 + 0.01)."""
        squares = [(x - y)**2 for x, y in zip(one, other)]
        return mean(squares), mean([s * w for s, w in zip(squares, self.weights)])

    def errors(self, picture):
        """Returns MSE and relMSE of a picture, with the noise of the reference subtracted. For a
        picture as good as the reference the results scatter about 0."""
        return [e - noise for e, noise in zip(self._squares(picture, self.values), self.noise)]


class Measured:
    """Errors of pictures that differ in the seed only. An error below the noise of the reference
    cannot be judged and is nan."""

    def __init__(self, reference, pictures):
        errors = [reference.errors(p) for p in pictures]
        mse, relmse = (mean([e[k] for e in errors]) for k in (0, 1))
        self.rmse = math.sqrt(mse) if mse > reference.noise[0] else math.nan
        self.relmse = relmse if relmse > reference.noise[1] else math.nan
        self.relmse_interval = half_width([e[1] for e in errors])
        means = [mean(p) / reference.mean - 1 for p in pictures]
        self.bias = mean(means)
        self.bias_interval = math.hypot(half_width(means),
                                        1.96 * reference.mean_error / reference.mean)


def at_time(curve, seconds):
    """Returns the error at a time from points (seconds, error): a power law between neighbours,
    None outside the measured times."""
    points = sorted((s, e) for s, e in curve if s > 0 and e > 0)
    for (s0, e0), (s1, e1) in zip(points, points[1:]):
        if s0 <= seconds <= s1:
            share = math.log(seconds / s0) / math.log(s1 / s0) if s1 > s0 else 0
            return e0 * (e1 / e0)**share
    return None


def ratio_of_means(new, old):
    """Returns mean(new) / mean(old) of values in pairs, and the factor of its 95 % interval: the
    interval is ratio / factor to ratio * factor (jackknife of the logarithm).

    Means, not medians: rare bright samples are the error of some worlds, and a median hides them.
    """
    n = len(new)
    ratio = mean(new) / mean(old) if min(mean(new), mean(old)) > 0 else math.nan
    if n < 2 or math.isnan(ratio):
        return ratio, math.nan
    left_out = []
    for k in range(n):
        above, below = math.fsum(new) - new[k], math.fsum(old) - old[k]
        if min(above, below) <= 0:
            return ratio, math.nan
        left_out.append(math.log(above / below))
    middle = mean(left_out)
    variance = (n - 1) / n * math.fsum((v - middle)**2 for v in left_out)
    return ratio, math.exp(t95(n - 1) * math.sqrt(variance))


def geometric_mean(values):
    known = [v for v in values if v > 0]
    return math.exp(mean([math.log(v) for v in known])) if known else math.nan
