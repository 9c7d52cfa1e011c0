# SPDX-License-Identifier: Apache-2.0
# Called by skimage.sh in an empty folder: similarity.py MCRENDER. Prints TAP.
# Images are made here from fixed seeds, written as PFM, and compared by mcrender and by scikit-image and numpy. Both sides compute in doubles from the same
# 32-bit floats; tolerances are 1e-10 of the value, for sums in another order and the cancellation in E a^2 - (E a)^2 (some 1e-16 beside C2 = 9e-4 peak^2).
import json
import subprocess
import sys

import numpy
import skimage.metrics

count = 0
failed = 0


def point(passed, what):
    global count, failed
    count += 1
    failed += not passed
    print('%s %d - %s' % ('ok' if passed else 'not ok', count, what))


def write_pfm(name, image):
    kind = 'PF' if image.ndim == 3 else 'Pf'
    with open(name, 'wb') as file:
        file.write(('%s\n%d %d\n-1\n' % (kind, image.shape[1], image.shape[0])).encode())
        file.write(image[::-1].astype('<f4').tobytes())


def compare(a, r, *options):
    write_pfm('a.pfm', a)
    write_pfm('r.pfm', r)
    result = subprocess.run([sys.argv[1], 'compare', 'a.pfm', 'r.pfm', '--json', *options], stdout=subprocess.PIPE, check=True)
    return json.loads(result.stdout)


def luminance(image):
    return 0.2126 * image[..., 0] + 0.7152 * image[..., 1] + 0.0722 * image[..., 2]


def ssim(a, r, peak):
    return skimage.metrics.structural_similarity(a, r, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=peak)


# Wang 2003, from the paper: the map of contrast * structure and of ssim by a direct sum over the 121 taps.
def ssim_maps(a, r, peak):
    taps = numpy.exp(-(numpy.arange(11) - 5.0) ** 2 / 4.5)
    window = numpy.outer(taps, taps) / taps.sum() ** 2
    h, w = a.shape[0] - 10, a.shape[1] - 10

    def mean(v):
        return sum(window[i, j] * v[i:i + h, j:j + w] for i in range(11) for j in range(11))
    ma, mr = mean(a), mean(r)
    contrast = (2 * (mean(a * r) - ma * mr) + (.03 * peak) ** 2) / (mean(a * a) - ma * ma + mean(r * r) - mr * mr + (.03 * peak) ** 2)
    return contrast, contrast * (2 * ma * mr + (.01 * peak) ** 2) / (ma * ma + mr * mr + (.01 * peak) ** 2)


def halved(v):
    v = numpy.pad(v, ((0, v.shape[0] % 2), (0, v.shape[1] % 2)), 'edge')
    return (v[::2, ::2] + v[1::2, ::2] + v[::2, 1::2] + v[1::2, 1::2]) / 4


def ms_ssim(a, r, peak):
    product = 1.0
    for scale, weight in enumerate((.0448, .2856, .3001, .2363, .1333)):
        contrast, whole = ssim_maps(a, r, peak)
        product *= max((whole if scale == 4 else contrast).mean(), 0) ** weight
        a, r = halved(a), halved(r)
    return product


def expected(a, r, peak):
    e = a - r
    both = numpy.abs(a) + numpy.abs(r)
    values = {
        'mse': skimage.metrics.mean_squared_error(r, a), 'rmse': numpy.sqrt(numpy.mean(e * e)), 'mae': numpy.mean(numpy.abs(e)),
        'relmse': numpy.mean(e * e / (r * r + .01 * peak * peak)), 'smape': numpy.mean(numpy.abs(e) / both),
        'psnr': skimage.metrics.peak_signal_noise_ratio(r, a, data_range=peak), 'snr': 10 * numpy.log10(numpy.sum(r * r) / numpy.sum(e * e)),
        'mean_ratio': numpy.sum(a) / numpy.sum(r),
    }
    planes = [(a[..., c], r[..., c]) for c in range(3)] if a.ndim == 3 else [(a, r)]
    values['snr_variance'] = 10 * numpy.log10(sum(numpy.var(y) for x, y in planes) / sum(numpy.var(x - y) for x, y in planes))
    values['ssim'] = numpy.mean([ssim(x, y, peak) for x, y in planes])
    values['ms_ssim'] = numpy.mean([ms_ssim(x, y, peak) for x, y in planes]) if min(a.shape[:2]) >= 176 else None
    return values


def same(found, wanted):
    for key, value in wanted.items():
        if value is None and found[key] is None:
            continue
        if value is None or found[key] is None or not abs(found[key] - value) <= 1e-10 * abs(value):
            print('# %s: %r, expected %r' % (key, found[key], value))
            return False
    return True


def scene(generator, shape, noise):
    y, x = numpy.mgrid[0:shape[0], 0:shape[1]]
    reference = .5 + .3 * numpy.sin(x / 7 + y / 11) + .2 * (x > y)
    if len(shape) == 3:
        reference = reference[..., None] * numpy.array([1, .6, .3])
    image = reference * 1.02 + noise * generator.standard_normal(shape)
    return image.astype('f4').astype('f8'), reference.astype('f4').astype('f8')


generator = numpy.random.default_rng(3)
for shape, peak, noise in (((16, 16), 1, .05), ((11, 11), 1, .1), ((31, 47), 2.5, .1), ((64, 50, 3), 1, .02), ((33, 35, 3), 10, .5), ((176, 177), 1, .1),
                           ((190, 211, 3), 1, .2), ((353, 180), 255, 4)):
    a, r = scene(generator, shape, noise)
    a, r = a * (peak if peak == 255 else 1), r * (peak if peak == 255 else 1)
    a, r = a.astype('f4').astype('f8'), r.astype('f4').astype('f8')
    found = compare(a, r, '--peak', str(peak))
    what = '%s, peak %g, noise %g' % ('x'.join(map(str, shape)), peak, noise)
    point(same(found, expected(a, r, peak)), what)
    if len(shape) == 3:
        for c in range(3):
            point(same(found['channels']['RGB'[c]], expected(a[..., c], r[..., c], peak)), what + ', channel ' + 'RGB'[c])
        point(same(found['channels']['luminance'], expected(luminance(a), luminance(r), peak)), what + ', luminance')

# Opposite patterns: contrast * structure below 0 at some scale.
y, x = numpy.mgrid[0:200, 0:200]
r = .5 + .4 * ((x // 3 + y // 3) % 2) - .2
a = (1 - r).astype('f4').astype('f8')
r = r.astype('f4').astype('f8')
found = compare(a, r)
point(found['ssim'] < 0 and found['ms_ssim'] == 0 and ms_ssim(a, r, 1) == 0 and same(found, expected(a, r, 1)), 'opposite patterns: ms_ssim is 0')

# 8-bit codes: sRGB of IEC 61966-2-1, rounded half up.
a, r = scene(generator, (60, 61, 3), .3)


def codes(v):
    v = numpy.clip(v, 0, 1)
    return numpy.floor(numpy.where(v <= .0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - .055) * 255 + .5)


with numpy.errstate(invalid='ignore'):
    wanted = expected(codes(a), codes(r), 255)
    wanted['smape'] = numpy.mean(numpy.nan_to_num(numpy.abs(codes(a) - codes(r)) / (codes(a) + codes(r))))
found = compare(a, r, '--encoding', 'srgb8')
point(same(found, wanted) and found['peak'] == 255, 'srgb8')

# A crop.
a, r = scene(generator, (90, 80, 3), .1)
point(same(compare(a, r, '--crop', '5,7,60,83'), expected(a[7:83, 5:60], r[7:83, 5:60], 1)), 'a crop')

print('1..%d' % count)
sys.exit(1 if failed else 0)
