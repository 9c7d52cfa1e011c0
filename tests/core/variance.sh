# SPDX-License-Identifier: Apache-2.0
# S16 and S17: the variance of *one sample* of a diffuse receiver (albedo .5) below a disk with R = 1 and R = .1 at h = 1, which tells that a
# sampler is what it says it is: an unbiased one with other densities has another variance. Within 5 %, at an error of the measured variance
# below 1 %: that is sqrt((kurtosis - 1) / N), worst for cosine and uniform at R = .1, where a share p = .01 and .005 of the samples is not black,
# the kurtosis is about 1 / p, and N is 4 million; elsewhere it is below 10 and N half a million.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
. "$srcdir/tests/core/scenes.sh"

variance_of() # SPP EXPECTED SAMPLER
{
    render "$TMPDIR/scene.scn" --sampler "$3" --size 16x16 --spp "$1" --seed 1 --set rho=0.5 || return
    holds 'abs(variance / expected - 1) < 0.05' variance="$variance" expected="$2"
    point $? "$name, $3: $variance, expected $2"
}

near='(0.3, 0.2, 0.5)'
area='light(by=area)'
angle='light(by=solid-angle)'
light()
{
    name=$1
    receiver scene "$near" "$2"
}
r1()
{
    variance_of 2048 .15298220313558 uniform
    variance_of 2048 .0625 cosine
    variance_of 2048 .0006132760733929 "$angle"
    variance_of 2048 .021197471073498 "mixture(cosine 1, $angle 1)"
}
r01()
{
    variance_of 16384 .0049137136515737 uniform
    variance_of 16384 .0024507401235173 cosine
    variance_of 2048 5.0550944576e-11 "$angle"
    variance_of 2048 2.4026962113e-5 "mixture(cosine 1, $angle 1)"
}

light 'S16, disk' 'disk { center (0, 0, 1)   normal (0, 0, -1)   radius 1   material lamp }'
r1
variance_of 2048 .010416666666667 "$area"
variance_of 2048 .026624722801679 "mixture(cosine 1, $area 1)"
variance_of 2048 .026624722801679 "mixture($area 3, cosine 3)"

light 'S17, disk' 'disk { center (0, 0, 1)   normal (0, 0, -1)   radius 0.1   material lamp }'
r01
variance_of 2048 8.0882512e-10 "$area"
variance_of 2048 2.402843449237e-5 "mixture(cosine 1, $area 1)"

# A sphere in the same cone of directions is the same light: sin^2 = R^2 / (R^2 + h^2).
light 'S16, sphere in the same cone' 'sphere { center (0, 0, 2)   radius 2 * sqrt(0.5)   material lamp }'
r1
light 'S17, sphere in the same cone' 'sphere { center (0, 0, 2)   radius 2 * sqrt(0.01 / 1.01)   material lamp }'
r01

finish
