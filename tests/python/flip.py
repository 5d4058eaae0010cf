"""Computes LDR-FLIP, how different two pictures look (Andersson and others, "FLIP: A Difference
Evaluator for Alternating Images", HPG 2020), at 67 pixels a degree."""
import numpy
from numpy.lib.stride_tricks import sliding_window_view

PIXELS_PER_DEGREE = 67
TO_XYZ = numpy.array([[0.41238656, 0.35759149, 0.18045049], [0.21263682, 0.71518298, 0.0721802],
                      [0.01933062, 0.11919716, 0.95037259]])
WHITE = TO_XYZ.sum(1)


def filtered(image, kernel):
    """Returns an image (height, width) filtered by a square kernel; edges are continued."""
    radius = len(kernel) // 2
    windows = sliding_window_view(numpy.pad(image, radius, "edge"), kernel.shape)
    return numpy.einsum("ijkl,kl->ij", windows, kernel)


def decoded(srgb):
    return numpy.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055)**2.4)


def opponent(xyz):
    """Returns YCxCz."""
    x, y, z = numpy.moveaxis(xyz / WHITE, 2, 0)
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


def perceived(picture):
    """Returns a picture as the eye resolves it, in L*a*b*."""
    radius = int(numpy.ceil(3 * numpy.sqrt(0.04 / (2 * numpy.pi**2)) * PIXELS_PER_DEGREE))
    square = (numpy.arange(-radius, radius + 1) / PIXELS_PER_DEGREE)**2
    square = square[:, None] + square
    seen = []
    for channel, terms in zip(opponent(decoded(picture) @ TO_XYZ.T),
                              (((1, 0.0047),), ((1, 0.0053),), ((34.1, 0.04), (13.5, 0.025)))):
        kernel = sum(a / numpy.sqrt(b) * numpy.exp(-numpy.pi**2 * square / b) for a, b in terms)
        seen.append(filtered(channel, kernel / kernel.sum()))
    y = (seen[0] + 16) / 116
    xyz = numpy.stack((y + seen[1] / 500, y, y - seen[2] / 200), 2) * WHITE
    return lab(numpy.clip(xyz @ numpy.linalg.inv(TO_XYZ).T, 0, 1))


def lab(linear):
    """Returns L*a*b* with Hunt's adjustment."""
    t = linear @ TO_XYZ.T / WHITE
    f = numpy.where(t > (6 / 29)**3, numpy.cbrt(t), t * (29 / 6)**2 / 3 + 4 / 29)
    lightness = 116 * f[..., 1] - 16
    hunt = 0.01 * lightness
    return numpy.stack((lightness, hunt * 500 * (f[..., 0] - f[..., 1]),
                        hunt * 200 * (f[..., 1] - f[..., 2])), -1)


def distance(a, b):
    """Returns HyAB to the power of 0.7."""
    d = a - b
    return (abs(d[..., 0]) + numpy.hypot(d[..., 1], d[..., 2]))**0.7


def features(picture):
    """Returns how strong edges and points are."""
    luminance = (opponent(decoded(picture) @ TO_XYZ.T)[0] + 16) / 116
    deviation = 0.5 * 0.082 * PIXELS_PER_DEGREE
    x = numpy.arange(-9, 10)  # three deviations
    gauss = numpy.exp(-(x**2 + x[:, None]**2) / (2 * deviation**2))
    strengths = []
    for kernel in (-x * gauss, (x**2 / deviation**2 - 1) * gauss):
        positive, negative = kernel[kernel > 0].sum(), -kernel[kernel < 0].sum()
        kernel = numpy.where(kernel > 0, kernel / positive, kernel / negative)
        strengths.append(numpy.hypot(filtered(luminance, kernel), filtered(luminance, kernel.T)))
    return strengths


def flip(a, b):
    """Returns the mean FLIP of two sRGB pictures of 0 to 1: 0 for equal ones, at most 1."""
    most = distance(lab(numpy.array([0., 1, 0])), lab(numpy.array([0., 0, 1])))
    colour, bend = distance(perceived(a), perceived(b)), 0.4 * most
    colour = numpy.interp(colour, (0, bend, most), (0, 0.95, 1))
    feature = numpy.maximum(*(abs(p - q) for p, q in zip(features(a), features(b))))
    return float((colour**(1 - numpy.sqrt(feature / numpy.sqrt(2)))).mean())
