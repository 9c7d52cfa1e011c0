/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/words.h"

#include <math.h>

#include <string.h>

#include "image/tone.h"

#define COUNT(table) ((uint32_t)(sizeof(table) / sizeof(table)[0]))

/* A row: word, type, flags, unit, minimum, maximum, defaults of the three components, summary. */
#define ROW(word, what, flag, unit_, min_, max_, f0, f1, f2, text)                                                                 \
    { .size = sizeof(struct mcr_parameter), .type = what, .flags = flag, .name = word, .unit = unit_, .summary = text,             \
      .fallback = { f0, f1, f2 }, .min = min_, .max = max_ }
#define CHOICE(word, words, text)                                                                                                  \
    { .size = sizeof(struct mcr_parameter), .type = MCR_TYPE_CHOICE, .name = word, .unit = "", .choices = words, .summary = text }

#define REQUIRED MCR_PARAMETER_REQUIRED
#define ABOVE MCR_PARAMETER_ABOVE_MIN
#define BELOW MCR_PARAMETER_BELOW_MAX
#define FAR MCR_EXTENT_LIMIT

#define POINT(word, flag, text) ROW(word, MCR_WORD_POINT, flag, "", -FAR, FAR, 0, 0, 0, text)
#define VECTOR(word, flag, text) ROW(word, MCR_WORD_VECTOR, flag, "", -FAR, FAR, 0, 0, 0, text)
#define LENGTH(word, flag, text) ROW(word, MCR_TYPE_NUMBER, (flag) | ABOVE, "", 0, FAR, 0, 0, 0, text)
#define WORD(word, type, flag, text) ROW(word, type, flag, "", -FAR, FAR, 0, 0, 0, text)

#define FRAME                                                                                                                      \
    [CAMERA_FROM] = POINT("from", REQUIRED, "Position."), [CAMERA_TO] = POINT("to", REQUIRED, "Point in the picture's centre."),   \
    [CAMERA_UP] = ROW("up", MCR_WORD_VECTOR, 0, "", -FAR, FAR, 0, 1, 0, "Direction that is up in the picture.")
#define PERSPECTIVE                                                                                                                \
    FRAME,                                                                                                                         \
    [CAMERA_FOV] = ROW("fov", MCR_TYPE_NUMBER, ABOVE | BELOW, "degrees", 0, 180, 0, 0, 0,                                          \
                       "Vertical field of view; or give focal and film_height."),                                                 \
    [CAMERA_FOCAL] = LENGTH("focal", 0, "Focal length, in the unit of film_height."),                                             \
    [CAMERA_FILM_HEIGHT] = LENGTH("film_height", 0, "Height of the film, in the unit of focal.")

static const struct mcr_parameter perspective[] = { PERSPECTIVE };
static const struct mcr_parameter orthographic[] = {
    FRAME,
    [ORTHOGRAPHIC_HEIGHT] = LENGTH("height", REQUIRED, "Height of what is seen, in world units."),
};
static const struct mcr_parameter thinlens[] = {
    PERSPECTIVE,
    [CAMERA_LENS_RADIUS] = ROW("lens_radius", MCR_TYPE_NUMBER, REQUIRED, "", 0, FAR, 0, 0, 0, "Radius of the lens, in world units."),
    [CAMERA_FOCUS_DISTANCE] = LENGTH("focus_distance", 0, "Distance of the sharp plane along the view; by default it goes through `to`."),
};

static const struct mcr_parameter film[] = {
    [FILM_SIZE] = ROW("size", MCR_WORD_PAIR, 0, "pixels", 1, MCR_FILM_LIMIT, 512, 512, 0, "Width and height of the picture."),
    [FILM_CROP] = ROW("crop", MCR_WORD_RECTANGLE, 0, "pixels", 0, MCR_FILM_LIMIT, 0, 0, 0,
                      "The part to render, from the top left: x0 <= x < x1, y0 <= y < y1; by default all."),
    [FILM_FILTER] = WORD("filter", MCR_WORD_FILTER, 0, "Reconstruction filter; box by default."),
    [FILM_EXPOSURE] = ROW("exposure", MCR_TYPE_NUMBER, 0, "stops", -64, 64, 0, 0, 0, "Brightens files of 8 and 16 bits by 2^stops; no others."),
    [FILM_TONE] = WORD("tone", MCR_WORD_TONE, 0, "Tone curve of files of 8 and 16 bits, behind the exposure; linear by default."),
};
static const struct mcr_parameter box_filter[] = {
    [FILTER_RADIUS] = ROW("radius", MCR_TYPE_NUMBER, ABOVE, "pixels", 0, 64, 0.5, 0, 0, "Half the width of the box."),
};
static const struct mcr_parameter tent_filter[] = {
    [FILTER_RADIUS] = ROW("radius", MCR_TYPE_NUMBER, ABOVE, "pixels", 0, 64, 1, 0, 0, "Where the tent reaches 0."),
};
static const struct mcr_parameter gaussian_filter[] = {
    [FILTER_RADIUS] = ROW("radius", MCR_TYPE_NUMBER, ABOVE, "pixels", 0, 64, 1.5, 0, 0, "Where the filter is cut."),
    [FILTER_SIGMA] = ROW("sigma", MCR_TYPE_NUMBER, ABOVE, "pixels", 0, 64, 0.5, 0, 0, "Standard deviation."),
};
static const struct mcr_parameter mitchell_filter[] = {
    [FILTER_RADIUS] = ROW("radius", MCR_TYPE_NUMBER, ABOVE, "pixels", 0, 64, 2, 0, 0, "Where the filter ends."),
    [FILTER_B] = ROW("b", MCR_TYPE_NUMBER, 0, "", 0, 1, 1.0 / 3, 0, 0, "Blur: 1 with c = 0 is the cubic B-spline."),
    [FILTER_C] = ROW("c", MCR_TYPE_NUMBER, 0, "", 0, 1, 1.0 / 3, 0, 0, "Ringing: 0.5 with b = 0 is the Catmull-Rom spline."),
};
static const struct mcr_parameter reinhard_tone[] = {
    [TONE_WHITE] = ROW("white", MCR_TYPE_NUMBER, 0, "", MCR_TONE_LEAST_WHITE, MCR_TONE_MOST_WHITE, 4, 0, 0, "The least luminance that becomes white."),
};
static const struct mcr_parameter hable_tone[] = {
    [TONE_WHITE] = ROW("white", MCR_TYPE_NUMBER, 0, "", MCR_TONE_LEAST_WHITE, MCR_TONE_MOST_WHITE, 5.6, 0, 0, "The least value that becomes 1."),
};
static const struct mcr_parameter roulette[] = {
    ROW("from", MCR_TYPE_INTEGER, 0, "", 0, 2147483646, 8, 0, 0, "The first scattering event, counted from 0, at which it may end a path."),
};

static const struct mcr_parameter adaptive[] = {
    ROW("floor", MCR_TYPE_INTEGER, 0, "", 1, 1048576, 16, 0, 0, "Samples of every pixel at least, rounded up to whole rounds."),
};

static const struct mcr_parameter render[] = {
    [RENDER_SAMPLER] = WORD("sampler", MCR_WORD_SAMPLER, 0,
                            "How directions and numbers are drawn; by default mixture(cosine 1, light 1) where there is light to sample, else cosine."),
    [RENDER_SPP] = ROW("spp", MCR_TYPE_INTEGER, 0, "", 1, 2147483647.0, 16, 0, 0, "Samples per pixel."),
    [RENDER_DEPTH] = ROW("depth", MCR_TYPE_INTEGER, 0, "", 0, 2147483646, 50, 0, 0,
                         "Scattering events of a path at most; 0 shows emission only."),
    [RENDER_SEED] = ROW("seed", MCR_TYPE_INTEGER, 0, "", 0, 9007199254740992.0, 0, 0, 0, "Another seed gives other noise."),
    [RENDER_THREADS] = ROW("threads", MCR_TYPE_INTEGER, 0, "", 0, 1024, 0, 0, 0, "Threads; 0 takes all processors."),
    [RENDER_REPLICATES] = ROW("replicates", MCR_TYPE_INTEGER, 0, "", 1, 4096, 0, 0, 0,
                              "Independent repetitions for the error estimate; by default 1, with correlated numbers 2 from 16 spp on."),
    [RENDER_ROULETTE] = WORD("roulette", MCR_WORD_ROULETTE, 0, "Ends paths early without bias; on(from=8) by default."),
    [RENDER_BACKGROUND] = ROW("background", MCR_TYPE_COLOUR, 0, "W/(sr m^2)", 0, FAR, 0, 0, 0, "Radiance from where there is nothing."),
    [RENDER_ACCEL] = CHOICE("accel", "auto|list|bvh|embree", "How the closest surface is found."),
    [RENDER_PRECISION] = CHOICE("precision", "double|single", "Precision of the accelerator."),
    [RENDER_MIS] = CHOICE("mis", "balance|power", "Heuristic by which techniques are combined."),
    [RENDER_BATCH] = ROW("batch", MCR_TYPE_INTEGER, 0, "", 0, 65536, 0, 0, 0, "Paths in a batch; 0 chooses."),
    [RENDER_COMPAT] = WORD("compat", MCR_WORD_COMPAT, 0, "Known mistakes to make on purpose, so that a study can show what each does; none by default."),
    [RENDER_TEXTURE_MEMORY] = ROW("texture_memory", MCR_TYPE_NUMBER, ABOVE, "MiB", 0, 1048576, MCR_TEXTURE_MEMORY, 0, 0,
                                  "What the pictures of all textures may take together; those that take more are reduced."),
    [RENDER_TIME] = ROW("time", MCR_TYPE_NUMBER, ABOVE, "seconds", 0, 1e9, 0, 0, 0, "Ends the rendering after so long, with one round of samples at least."),
    [RENDER_TARGET_ERROR] = ROW("target_error", MCR_TYPE_NUMBER, ABOVE, "", 0, FAR, 0, 0, 0,
                                "Ends the rendering when the picture's relative error is not above this, with 95 % confidence."),
    [RENDER_ADAPTIVE] = WORD("adaptive", MCR_WORD_ADAPTIVE, 0, "Gives noisy pixels more samples, without bias; off by default."),
    [RENDER_ROUND] = ROW("round", MCR_TYPE_INTEGER, 0, "", 1, 65536, 16, 0, 0,
                         "Samples that time, target_error and adaptive add to a pixel at once; correlated numbers are laid out by rounds."),
};

#define WORDS(word, words, text)                                                                                                   \
    { .size = sizeof(struct mcr_parameter), .type = MCR_WORD_CHOICES, .name = word, .unit = "", .choices = words, .summary = text,     \
      .min = -FAR, .max = FAR }

static const struct mcr_parameter study[] = {
    [STUDY_TITLE] = WORD("title", MCR_WORD_TEXT, 0, "Of the report; the scene's file name by default."),
    [STUDY_SAMPLERS] = WORD("samplers", MCR_WORD_SAMPLERS, 0, "What is compared; the sampler of `render` by default."),
    [STUDY_SPP] = ROW("spp", MCR_WORD_WHOLES, 0, "", 1, 2147483647.0, 0, 0, 0, "Samples per pixel; those of `render` by default, as in what follows."),
    [STUDY_DEPTH] = ROW("depth", MCR_WORD_WHOLES, 0, "", 0, 2147483646, 0, 0, 0, "Scattering events of a path at most."),
    [STUDY_PRECISION] = WORDS("precision", "double|single", "Precisions of the accelerator."),
    [STUDY_ACCEL] = WORDS("accel", "auto|list|bvh|embree", "Accelerators."),
    [STUDY_ROULETTE] = WORDS("roulette", "off|on", "Whether paths are ended early; from which event on is said in `render`."),
    [STUDY_COMPAT] = WORD("compat", MCR_WORD_COMPATS, 0, "Known mistakes to make; a tuple within the tuple makes several at once."),
    [STUDY_SEEDS] = ROW("seeds", MCR_TYPE_INTEGER, 0, "", 1, 100000, 10, 0, 0, "Independent renders of each cell for its error."),
    [STUDY_RUNS] = ROW("runs", MCR_TYPE_INTEGER, 0, "", 1, 100000, 10, 0, 0, "Timed renders of each cell; the same renders as for the error."),
    [STUDY_SEED] = ROW("seed", MCR_TYPE_INTEGER, 0, "", 0, 4503599627370496.0, 1, 0, 0, "Of the first run of each cell; the next has one more."),
    [STUDY_BASELINE] = WORD("baseline", MCR_WORD_SAMPLER, 0, "The sampler that efficiency is relative to; by default the first that covers the scene."),
    [STUDY_CONFIDENCE] = ROW("confidence", MCR_TYPE_NUMBER, ABOVE | BELOW, "", 0.5, 1, 0.95, 0, 0, "Of intervals and verdicts."),
    [STUDY_TARGET] = ROW("target", MCR_TYPE_NUMBER, ABOVE, "", 0, FAR, 0, 0, 0, "Mean square error whose time is asked for; chosen by default."),
    [STUDY_METRICS] = WORDS("metrics", MCR_METRIC_WORDS, "What is measured; mse psnr snr ssim ms_ssim and relmse by default, mse always."),
    [STUDY_ENCODING] = CHOICE("encoding", "linear|srgb8", "What the metrics are computed on."),
    [STUDY_PEAK] = ROW("peak", MCR_TYPE_NUMBER, ABOVE, "", 0, FAR, 0, 0, 0, "Value that counts as white; 1 by default, 255 for srgb8."),
    [STUDY_OUTPUT] = WORD("output", MCR_WORD_TEXT, 0, "Folder for everything; the scene's name with -study by default."),
    [STUDY_SIZE] = ROW("size", MCR_WORD_PAIR, 0, "pixels", 1, MCR_FILM_LIMIT, 512, 512, 0, "Width and height of the picture; those of `film` by default."),
    [STUDY_CROP] = ROW("crop", MCR_WORD_RECTANGLE, 0, "pixels", 0, MCR_FILM_LIMIT, 0, 0, 0, "The part to render; that of `film` by default."),
};
static const struct mcr_parameter reference[] = {
    [REFERENCE_SAMPLER] = WORD("sampler", MCR_WORD_SAMPLER, 0, "By default mixture(cosine 1, light 1) where there is light to sample, else cosine."),
    [REFERENCE_SPP] = ROW("spp", MCR_TYPE_INTEGER, 0, "", 1, 2147483647.0, 0, 0, 0, "Samples per pixel; by default 16 times the study's most, at least 1024."),
    [REFERENCE_DEPTH] = ROW("depth", MCR_TYPE_INTEGER, 0, "", 0, 2147483646, 0, 0, 0, "One reference of this depth for all; by default one for each depth."),
    [REFERENCE_SEED] = ROW("seed", MCR_TYPE_INTEGER, 0, "", 0, 9007199254740992.0, 0, 0, 0, "A seed that no run uses, and 15 that follow it."),
    [REFERENCE_IMAGE] = WORD("image", MCR_WORD_TEXT, 0, "Or a file that is the reference."),
};

#define SHAPE                                                                                                                      \
    [SHAPE_MATERIAL] = WORD("material", MCR_WORD_MATERIAL, REQUIRED, "Name of a material."),                                       \
    [SHAPE_TRANSFORM] = WORD("transform", MCR_WORD_TRANSFORM, 0, "Block of steps that move this shape.")

static const struct mcr_parameter plane[] = {
    SHAPE,
    [PLANE_POINT] = POINT("point", REQUIRED, "Any point of the plane."),
    [PLANE_NORMAL] = VECTOR("normal", REQUIRED, "Direction of its front."),
};
static const struct mcr_parameter sphere[] = {
    SHAPE,
    [SPHERE_CENTER] = POINT("center", REQUIRED, "Centre."),
    [SPHERE_RADIUS] = LENGTH("radius", REQUIRED, "Radius."),
};
static const struct mcr_parameter quad[] = {
    SHAPE,
    [QUAD_CORNER] = POINT("corner", 0, "A corner, with u and v."),
    [QUAD_U] = VECTOR("u", 0, "Edge from the corner; the front is where u x v points."),
    [QUAD_V] = VECTOR("v", 0, "The other edge from the corner."),
    [QUAD_CORNERS] = WORD("corners", MCR_WORD_POINTS4, 0, "Or four corners, counter-clockwise seen from the front."),
};
static const struct mcr_parameter disk[] = {
    SHAPE,
    [DISK_CENTER] = POINT("center", REQUIRED, "Centre."),
    [DISK_NORMAL] = VECTOR("normal", REQUIRED, "Direction of its front."),
    [DISK_RADIUS] = LENGTH("radius", REQUIRED, "Radius."),
};
static const struct mcr_parameter box[] = {
    SHAPE,
    [BOX_CORNER] = POINT("corner", 0, "Corner with the smallest coordinates; (0, 0, 0) by default."),
    [BOX_SIZE] = ROW("size", MCR_WORD_VECTOR, ABOVE, "", 0, FAR, 0, 0, 0, "Lengths along the axes."),
    [BOX_MIN] = POINT("min", 0, "Or the smallest coordinates, with max."),
    [BOX_MAX] = POINT("max", 0, "The largest coordinates."),
};
static const struct mcr_parameter triangle[] = {
    SHAPE,
    [TRIANGLE_A] = POINT("a", REQUIRED, "First corner; counter-clockwise seen from the front."),
    [TRIANGLE_B] = POINT("b", REQUIRED, "Second corner."),
    [TRIANGLE_C] = POINT("c", REQUIRED, "Third corner."),
    [TRIANGLE_NORMALS] = WORD("normals", MCR_WORD_POINTS3, 0, "Shading normals at the corners."),
    [TRIANGLE_UV] = WORD("uv", MCR_WORD_UVS3, 0, "Surface coordinates at the corners."),
};
static const struct mcr_parameter mesh[] = {
    SHAPE,
    [MESH_VERTICES] = WORD("vertices", MCR_WORD_POINT_LIST, REQUIRED, "Points, numbered from 0."),
    [MESH_FACES] = ROW("faces", MCR_WORD_FACE_LIST, REQUIRED, "", 0, 4294967294.0, 0, 0, 0,
                       "Triangles and quadrilaterals by vertex numbers, counter-clockwise seen from the front."),
    [MESH_NORMALS] = WORD("normals", MCR_WORD_POINT_LIST, 0, "Shading normals, one a vertex."),
    [MESH_UV] = WORD("uv", MCR_WORD_UV_LIST, 0, "Surface coordinates, one pair a vertex."),
};
#define LIGHT [LIGHT_TRANSFORM] = WORD("transform", MCR_WORD_TRANSFORM, 0, "Block of steps that move this light.")
#define LAMP                                                                                                                       \
    LIGHT,                                                                                                                         \
    [POINT_POSITION] = POINT("position", REQUIRED, "Where it is."),                                                                \
    [POINT_INTENSITY] = ROW("intensity", MCR_TYPE_COLOUR, 0, "W/sr", 0, FAR, 0, 0, 0, "Radiant intensity; of a spot on its axis."),  \
    [POINT_POWER] = ROW("power", MCR_TYPE_COLOUR, 0, "W", 0, FAR, 0, 0, 0, "Or the power that it radiates in all.")

static const struct mcr_parameter point[] = { LAMP };
static const struct mcr_parameter spot[] = {
    LAMP,
    [SPOT_TO] = POINT("to", 0, "A point on its axis."),
    [SPOT_DIRECTION] = VECTOR("direction", 0, "Or the direction of its axis, away from it."),
    [SPOT_ANGLE] = ROW("angle", MCR_TYPE_NUMBER, ABOVE, "degrees", 0, 180, 30, 0, 0, "From the axis to the edge of the light."),
    [SPOT_SOFTNESS] = ROW("softness", MCR_TYPE_NUMBER, 0, "", 0, 1, 0.2, 0, 0,
                          "The outer part of the angle over which the light falls off; 0 is a hard edge."),
};
static const struct mcr_parameter sun[] = {
    LIGHT,
    [SUN_DIRECTION] = VECTOR("direction", REQUIRED, "Direction in which its light travels."),
    [SUN_IRRADIANCE] = ROW("irradiance", MCR_TYPE_COLOUR, 0, "W/m^2", 0, FAR, 0, 0, 0, "On a surface that faces it."),
    [SUN_RADIANCE] = ROW("radiance", MCR_TYPE_COLOUR, 0, "W/(sr m^2)", 0, FAR, 0, 0, 0, "Or its radiance, with an angular radius."),
    [SUN_ANGULAR_RADIUS] = ROW("angular_radius", MCR_TYPE_NUMBER, 0, "degrees", 0, 90, 0, 0, 0,
                               "Of its disk in the sky; 0: parallel light, and nothing to be seen."),
};
static const struct mcr_parameter environment[] = {
    LIGHT,
    [SKY_RADIANCE] = ROW("radiance", MCR_TYPE_COLOUR, 0, "W/(sr m^2)", 0, FAR, 0, 0, 0, "The same from everywhere."),
    [SKY_ZENITH] = ROW("zenith", MCR_TYPE_COLOUR, 0, "W/(sr m^2)", 0, FAR, 0, 0, 0,
                       "Or from above: with horizon, linear in the cosine to +y between the two."),
    [SKY_HORIZON] = ROW("horizon", MCR_TYPE_COLOUR, 0, "W/(sr m^2)", 0, FAR, 0, 0, 0, "From the horizon."),
    [SKY_NADIR] = ROW("nadir", MCR_TYPE_COLOUR, 0, "W/(sr m^2)", 0, FAR, 0, 0, 0, "From below; that of the horizon by default."),
    [SKY_IMAGE] = WORD("image", MCR_WORD_TEXT, 0, "Or a file, by longitude and latitude: top row at +y, middle along +z, +x in the left half."),
    [SKY_FILTER] = CHOICE("filter", "nearest|bilinear", "Between the texels of the image."),
    [SKY_COLOUR] = CHOICE("colour", "auto|linear|srgb", "How the image's numbers are encoded; auto goes by the file."),
    [SKY_SCALE] = ROW("scale", MCR_TYPE_NUMBER, 0, "", 0, FAR, 1, 0, 0, "Factor on all of it."),
};
static const struct mcr_parameter group[] = {
    WORD("transform", MCR_WORD_TRANSFORM, 0, "Block of steps that move all that is in the group."),
};
static const struct mcr_parameter transform[] = {
    [STEP_TRANSLATE] = VECTOR("translate", 0, "Moves by (x, y, z)."),
    [STEP_ROTATE] = WORD("rotate", MCR_WORD_ROTATION, 0,
                         "Turns about an axis through the origin by degrees: about y, x' = x cos + z sin, z' = -x sin + z cos."),
    [STEP_SCALE] = WORD("scale", MCR_WORD_SCALE, 0, "Scales from the origin, by one factor or three."),
    [STEP_MATRIX] = WORD("matrix", MCR_WORD_MATRIX, 0, "Affine map of column vectors, row after row; a fourth row must be 0, 0, 0, 1."),
    [STEP_LOOKAT] = WORD("lookat", MCR_WORD_LOOKAT, 0, "Puts the origin at `from`, turns +z toward `to` and +y toward `up`."),
};

#define TEXTURE                                                                                                                    \
    [TEXTURE_SCALE] = ROW("scale", MCR_WORD_PAIR_OR_NUMBER, 0, "", -MCR_TEXTURE_SCALE_MOST, MCR_TEXTURE_SCALE_MOST, 1, 1, 0,        \
                          "Multiplies u and v, by one factor or two: how often the texture stands along a unit."),                \
    [TEXTURE_OFFSET] = ROW("offset", MCR_WORD_UV, 0, "", -MCR_TEXTURE_SCALE_MOST, MCR_TEXTURE_SCALE_MOST, 0, 0, 0,                  \
                           "Added to u and v after that.")

static const struct mcr_parameter checker[] = {
    TEXTURE,
    [CHECKER_EVEN] = ROW("even", MCR_TYPE_COLOUR, REQUIRED, "", -FAR, FAR, 0, 0, 0, "Colour of the field at (0, 0) to (1, 1)."),
    [CHECKER_ODD] = ROW("odd", MCR_TYPE_COLOUR, REQUIRED, "", -FAR, FAR, 0, 0, 0, "Colour of its neighbours."),
    [CHECKER_FILTER] = CHOICE("filter", "box|none", "Whether a footprint sees the mean of what it covers."),
};

static const struct mcr_parameter surface[SURFACE_COUNT] = {
    [SURFACE_EMISSION] = ROW("emission", MCR_TYPE_COLOUR, MCR_PARAMETER_VARYING, "W/(sr m^2)", 0, FAR, 0, 0, 0,
                             "Radiance that the surface emits beside what its material does; a colour or a texture."),
    [SURFACE_EMISSION_SIDES] = CHOICE("emission_sides", "front|both", "The sides that emit it."),
    [SURFACE_NORMAL_MAP] = WORD("normal_map", MCR_WORD_TEXTURE, 0, "Texture of shading normals in tangent space."),
    [SURFACE_NORMAL_STRENGTH] = ROW("normal_strength", MCR_TYPE_NUMBER, 0, "", 0, 1e6, 1, 0, 0, "Multiplies the slopes of the normal map."),
    [SURFACE_BUMP] = WORD("bump", MCR_WORD_TEXTURE, 0, "Texture of heights that tilt the shading normal."),
    [SURFACE_BUMP_HEIGHT] = ROW("bump_height", MCR_TYPE_NUMBER, 0, "", -FAR, FAR, 0, 0, 0, "Length that the height 1 stands for; needed with bump."),
};
static const struct mcr_parameter image[] = {
    TEXTURE,
    [IMAGE_FILE] = WORD("file", MCR_WORD_TEXT, REQUIRED, "The picture, relative to the file that names it."),
    [IMAGE_WRAP] = WORD("wrap", MCR_WORD_WRAP, 0, "What is beside the picture; repeat by default."),
    [IMAGE_FILTER] = { .size = sizeof(struct mcr_parameter), .type = MCR_TYPE_CHOICE, .name = "filter", .unit = "",
                       .choices = "nearest|bilinear|mipmap", .fallback = { 1 }, .summary = "How a value is made of texels." },
    [IMAGE_COLOUR] = CHOICE("colour", "auto|linear|srgb", "How numbers are encoded; auto goes by the file."),
    [IMAGE_CHANNEL] = CHOICE("channel", "auto|red|green|blue|alpha|luminance", "One number instead of the colour."),
};
static const struct mcr_parameter gradient[] = {
    TEXTURE,
    [GRADIENT_FROM] = ROW("from", MCR_TYPE_COLOUR, 0, "", -FAR, FAR, 0, 0, 0, "Colour at the start, with to."),
    [GRADIENT_TO] = ROW("to", MCR_TYPE_COLOUR, 0, "", -FAR, FAR, 0, 0, 0, "Colour at the end."),
    [GRADIENT_STOPS] = WORD("stops", MCR_WORD_STOPS, 0, "Or positions from 0 to 1 in ascending order, each with its colour."),
    [GRADIENT_ALONG] = CHOICE("along", "u|v|radial", "From left to right, from bottom to top, or from (0.5, 0.5) to a distance of 0.5."),
    [GRADIENT_WRAP] = CHOICE("wrap", "clamp|repeat|mirror", "What comes before the start and behind the end."),
};

#define BLOCK(word, kind, role, table, text) { word, kind, role, COUNT(table), table, text }

const struct mcr_block_word mcr_scene_blocks[] = {
    BLOCK("camera", "perspective", MCR_BLOCK_CAMERA, perspective, "A pinhole camera."),
    BLOCK("camera", "orthographic", MCR_BLOCK_CAMERA, orthographic, "Parallel rays."),
    BLOCK("camera", "thinlens", MCR_BLOCK_CAMERA, thinlens, "A camera with depth of field."),
    BLOCK("film", NULL, MCR_BLOCK_FILM, film, "The picture."),
    BLOCK("render", NULL, MCR_BLOCK_RENDER, render, "How it is computed."),
    BLOCK("study", NULL, MCR_BLOCK_STUDY, study, "What `mcrender study` compares; other commands check it and do without."),
    BLOCK("material", NULL, MCR_BLOCK_MATERIAL, surface, "A named material; its kind is a plugin, whose parameters are its settings, beside these."),
    BLOCK("texture", "image", MCR_BLOCK_TEXTURE, image, "A picture from a file."),
    BLOCK("texture", "checker", MCR_BLOCK_TEXTURE, checker, "Two colours, field by field."),
    BLOCK("texture", "gradient", MCR_BLOCK_TEXTURE, gradient, "Colours that pass into each other."),
    BLOCK("light", "point", MCR_BLOCK_LIGHT, point, "A point that radiates alike in all directions."),
    BLOCK("light", "spot", MCR_BLOCK_LIGHT, spot, "A point that radiates into a cone."),
    BLOCK("light", "sun", MCR_BLOCK_LIGHT, sun, "Parallel light, or a disk that is infinitely far."),
    BLOCK("light", "environment", MCR_BLOCK_LIGHT, environment, "Light from infinitely far all around; a scene has at most one."),
    BLOCK("plane", NULL, MCR_BLOCK_SHAPE, plane, "An infinite plane."),
    BLOCK("sphere", NULL, MCR_BLOCK_SHAPE, sphere, "A sphere; its front is outside."),
    BLOCK("quad", NULL, MCR_BLOCK_SHAPE, quad, "A parallelogram, or any flat convex quadrilateral."),
    BLOCK("disk", NULL, MCR_BLOCK_SHAPE, disk, "A flat disk."),
    BLOCK("box", NULL, MCR_BLOCK_SHAPE, box, "A box along the axes; its front is outside."),
    BLOCK("triangle", NULL, MCR_BLOCK_SHAPE, triangle, "One triangle."),
    BLOCK("mesh", NULL, MCR_BLOCK_SHAPE, mesh, "Triangles and quadrilaterals that share vertices."),
    BLOCK("group", NULL, MCR_BLOCK_GROUP, group, "Shapes, lights and groups that are moved together."),
    BLOCK("transform", NULL, MCR_BLOCK_TRANSFORM, transform, "Steps, applied to points in the order of the text."),
    BLOCK("reference", NULL, MCR_BLOCK_REFERENCE, reference, "What a study measures against."),
};
const uint32_t mcr_scene_block_count = COUNT(mcr_scene_blocks);

const struct mcr_block_word mcr_filter_words[MCR_FILTER_COUNT] = {
    BLOCK("box", NULL, MCR_BLOCK_FILM, box_filter, "Constant."),
    BLOCK("tent", NULL, MCR_BLOCK_FILM, tent_filter, "Falls off linearly in x and y."),
    BLOCK("gaussian", NULL, MCR_BLOCK_FILM, gaussian_filter, "A Gaussian, cut off in a circle."),
    BLOCK("mitchell", NULL, MCR_BLOCK_FILM, mitchell_filter, "Mitchell and Netravali's cubic, sharper, negative in part."),
};
const struct mcr_block_word mcr_tone_words[MCR_TONE_WORDS] = {
    { "linear", NULL, MCR_BLOCK_FILM, 0, NULL, "As it is; what is above 1 is clipped." },
    BLOCK("reinhard", NULL, MCR_BLOCK_FILM, reinhard_tone, "Compresses luminance, keeps hues."),
    BLOCK("hable", NULL, MCR_BLOCK_FILM, hable_tone, "Filmic, with toe and shoulder."),
    { "aces", NULL, MCR_BLOCK_FILM, 0, NULL, "Filmic, with more contrast." },
};
const struct mcr_block_word mcr_roulette_word = BLOCK("on", NULL, MCR_BLOCK_RENDER, roulette, "Russian roulette.");
const struct mcr_block_word mcr_adaptive_word = BLOCK("on", NULL, MCR_BLOCK_RENDER, adaptive, "More samples where more noise is.");

const struct mcr_block_word *mcr_scene_block(const char *word, const char *kind)
{
    for (uint32_t i = 0; i < mcr_scene_block_count; i++) {
        const struct mcr_block_word *row = &mcr_scene_blocks[i];
        if (strcmp(row->word, word) == 0 && (!row->kind || (kind && strcmp(row->kind, kind) == 0)))
            return row;
    }
    return NULL;
}

const char *mcr_word_form(uint32_t type)
{
    static const char *const form[] = {
        [MCR_WORD_POINT] = "3 numbers (x, y, z)",
        [MCR_WORD_VECTOR] = "3 numbers (x, y, z)",
        [MCR_WORD_PAIR] = "2 whole numbers (width, height)",
        [MCR_WORD_RECTANGLE] = "4 whole numbers (x0, y0, x1, y1)",
        [MCR_WORD_SCALE] = "a number or 3 numbers (x, y, z)",
        [MCR_WORD_ROTATION] = "4 numbers (x, y, z, degrees)",
        [MCR_WORD_MATRIX] = "12 or 16 numbers, row after row",
        [MCR_WORD_LOOKAT] = "3 points (from, to, up)",
        [MCR_WORD_POINTS3] = "3 tuples (x, y, z)",
        [MCR_WORD_POINTS4] = "4 points (x, y, z)",
        [MCR_WORD_UVS3] = "3 pairs (u, v)",
        [MCR_WORD_POINT_LIST] = "a tuple of tuples (x, y, z)",
        [MCR_WORD_UV_LIST] = "a tuple of pairs (u, v)",
        [MCR_WORD_FACE_LIST] = "a tuple of faces (i, j, k) or (i, j, k, l)",
        [MCR_WORD_MATERIAL] = "the name of a material",
        [MCR_WORD_SAMPLER] = "a sampler such as cosine or mixture(cosine 1, light 1)",
        [MCR_WORD_FILTER] = "box, tent, gaussian or mitchell",
        [MCR_WORD_TONE] = "linear, reinhard, hable or aces",
        [MCR_WORD_ROULETTE] = "on, off or on(from=N)",
        [MCR_WORD_ADAPTIVE] = "on, off or on(floor=N)",
        [MCR_WORD_COMPAT] = "none, clamp, background-at-limit, disk-polar, sphere-spherical or floor-sqrt, or a tuple of these",
        [MCR_WORD_TEXT] = "a text in quotes",
        [MCR_WORD_SAMPLERS] = "a sampler such as cosine or a tuple of samplers",
        [MCR_WORD_WHOLES] = "a whole number or a tuple of them",
        [MCR_WORD_CHOICES] = "a word or a tuple of words",
        [MCR_WORD_COMPATS] = "none, a quirk such as clamp, or a tuple of these and of tuples",
        [MCR_WORD_PAIR_OR_NUMBER] = "a number or 2 numbers (u, v)",
        [MCR_WORD_UV] = "2 numbers (u, v)",
        [MCR_WORD_WRAP] = "repeat, mirror or clamp, or 2 of them (for u, for v)",
        [MCR_WORD_TEXTURE] = "the name of a texture",
        [MCR_WORD_STOPS] = "a tuple of stops (position, colour)",
        [MCR_WORD_TRANSFORM] = "a block transform { ... }",
        [MCR_TYPE_NUMBER] = "a number",
        [MCR_TYPE_INTEGER] = "a whole number",
        [MCR_TYPE_COLOUR] = "a colour",
        [MCR_TYPE_CHOICE] = "a word",
    };
    return type < sizeof form / sizeof form[0] && form[type] ? form[type] : "a value";
}
