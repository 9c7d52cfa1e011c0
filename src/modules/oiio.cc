/* SPDX-License-Identifier: Apache-2.0 */
/*
 * OpenImageIO behind the C table of image/oiio.h. Files are encoded to and decoded from memory, so that opening, writing,
 * checking and renaming stay in one place (src/image/target.c) and no path is interpreted by a library.
 */
#include "image/oiio.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

namespace {

/* Rows that are handed over at once: a multiple of every block height of EXR and of TIFF's strips. */
constexpr uint32_t chunk_rows = 64;

/* ITU-R BT.709 red, green, blue, white. */
const float rec709[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

#if OIIO_VERSION >= 30100
const char *const linear_name = "lin_rec709_scene", *const srgb_name = "srgb_rec709_scene";
#elif OIIO_VERSION >= 30000
const char *const linear_name = "lin_rec709", *const srgb_name = "sRGB";
#else
const char *const linear_name = "Linear", *const srgb_name = "sRGB";
#endif

int32_t fail(char *error, uint64_t length, const std::string &text)
{
    std::string line = text.empty() ? "OpenImageIO gave no reason" : text;
    while (!line.empty() && line.back() == '\n') line.pop_back();
    std::replace(line.begin(), line.end(), '\n', ' ');
    std::snprintf(error, length, "%s", line.c_str());
    return -1;
}

/* Runs a body; nothing that it throws passes, and no message stays behind in OpenImageIO (which would print it at exit). */
template<class Body> int32_t guarded(char *error, uint64_t length, Body body)
{
    int32_t status = -1;
    if (length) error[0] = '\0';
    try {
        status = body();
    } catch (const std::bad_alloc &) {
        std::snprintf(error, length, "not enough memory");
    } catch (const std::exception &e) {
        std::snprintf(error, length, "%s", e.what());
    } catch (...) {
        std::snprintf(error, length, "an unknown C++ exception");
    }
    try {
        if (OIIO::has_error()) (void)OIIO::geterror();
    } catch (...) {
    }
    return status;
}

/* No plugins of others, no threads of its own, limits against hostile headers. */
void settle(const mcr_oiio_input *input)
{
    OIIO::attribute("plugin_searchpath", "");
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", -1);
    if (!input) return;
    OIIO::attribute("limits:imagesize_MB", static_cast<int>(std::min<uint64_t>(input->max_bytes >> 20, 32768)));
    OIIO::attribute("limits:channels", static_cast<int>(input->max_channels));
}

int32_t check(const char *format, char *error, uint64_t length)
{
    return guarded(error, length, [&]() -> int32_t {
        settle(nullptr);
        auto output = OIIO::ImageOutput::create(format);
        auto input = output ? OIIO::ImageInput::create(format, false) : nullptr;
        if (!input) return fail(error, length, std::string("this OpenImageIO was built without the format ") + format);
        if (!output->supports("ioproxy") || !input->supports("ioproxy"))
            return fail(error, length, std::string("this OpenImageIO cannot encode to memory in the format ") + format);
        return 0;
    });
}

OIIO::ImageSpec output_spec(const mcr_oiio_output *output, OIIO::TypeDesc type)
{
    OIIO::ImageSpec spec(static_cast<int>(output->width), static_cast<int>(output->height), static_cast<int>(output->channels), type);
    spec.alpha_channel = spec.z_channel = -1;
    for (uint32_t c = 0; c < output->channels; c++) {
        spec.channelnames[c] = output->channel[c];
        if (spec.channelnames[c] == "A") spec.alpha_channel = static_cast<int>(c);
        if (spec.channelnames[c] == "Z") spec.z_channel = static_cast<int>(c);
    }
    const std::string format = output->format;
    const bool linear = output->type == MCR_OIIO_FLOAT;
    /*
     * "sRGB" makes the TIFF writer add an EXIF directory, which versions up to 2.4 at least spoil when they write to memory: the
     * file cannot be read again. Integers in TIFF are sRGB by convention.
     */
    if (linear || format != "tiff") spec.attribute("oiio:ColorSpace", linear ? linear_name : srgb_name);
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), rec709);
    spec.attribute("DateTime", output->date); /* else OpenImageIO sets the local time */
    spec.attribute("Software", "mcrender");
    if (format == "openexr") {
        spec.attribute("compression", "zip");
        spec.attribute("colorInteropID", "lin_rec709_scene"); /* Color Interop Forum; what OpenImageIO 3.1 looks for */
    } else if (format == "tiff") {
        spec.attribute("compression", "zip");
    } else if (format == "jpeg") {
        spec.attribute("compression", "jpeg:95");
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    for (uint32_t i = 0; i < output->attribute_count; i++) spec.attribute(output->attribute[i].name, output->attribute[i].text);
    return spec;
}

int32_t write(const mcr_oiio_output *output, char *error, uint64_t length)
{
    return guarded(error, length, [&]() -> int32_t {
        settle(nullptr);
        const OIIO::TypeDesc type = output->type == MCR_OIIO_U8    ? OIIO::TypeDesc::UINT8
                                    : output->type == MCR_OIIO_U16 ? OIIO::TypeDesc::UINT16
                                                                   : OIIO::TypeDesc::FLOAT;
        /* The proxy outlives the writer, which may still write to it when it is destroyed. */
        std::vector<unsigned char> file;
        OIIO::Filesystem::IOVecOutput proxy(file);
        auto writer = OIIO::ImageOutput::create(output->format);
        if (!writer) return fail(error, length, OIIO::geterror());
        if (!writer->set_ioproxy(&proxy)) return fail(error, length, "this OpenImageIO cannot encode to memory");
        if (!writer->open("output", output_spec(output, type))) return fail(error, length, writer->geterror());
        const size_t stride = size_t(output->width) * output->channels * type.size();
        std::vector<unsigned char> rows(stride * std::min(output->height, chunk_rows));
        for (uint32_t y = 0; y < output->height; y += chunk_rows) {
            const uint32_t end = std::min(output->height, y + chunk_rows);
            for (uint32_t row = y; row < end; row++) output->row(output->context, row, &rows[(row - y) * stride]);
            if (!writer->write_scanlines(static_cast<int>(y), static_cast<int>(end), 0, type, rows.data()))
                return fail(error, length, writer->geterror());
        }
        if (!writer->close()) return fail(error, length, writer->geterror());
        return output->put(output->context, file.data(), file.size());
    });
}

/*
 * How the values are encoded, by the file's colour space; floats are linear whatever it says. "Rec709" is what OpenImageIO makes of every PPM, and
 * what is shown like sRGB. False: one that we do not decode.
 */
bool transfer(const OIIO::ImageSpec &spec, mcr_oiio_header &header, std::string &space)
{
    space = spec.get_string_attribute("oiio:ColorSpace");
    header.transfer = header.bits ? MCR_OIIO_SRGB : MCR_OIIO_LINEAR;
    if (!header.bits || space.empty()) return true;
    for (const char *name : {"sRGB", "srgb_rec709_scene", "Rec709", "srgb_rec709_display", "srgb_texture"})
        if (OIIO::Strutil::iequals(space, name)) return true;
    for (const char *name : {"Linear", "scene_linear", "lin_srgb", "lin_rec709", "lin_rec709_scene"}) {
        if (!OIIO::Strutil::iequals(space, name)) continue;
        header.transfer = MCR_OIIO_LINEAR;
        return true;
    }
    header.gamma = spec.get_float_attribute("oiio:Gamma", 0.0f);
    header.transfer = MCR_OIIO_GAMMA;
    return OIIO::Strutil::istarts_with(space, "gamma") && header.gamma > 0.1 && header.gamma < 10;
}

/* How many samples or replicates a variance layer was made of, 0 where the file does not say. */
uint32_t units(const OIIO::ImageSpec &spec)
{
    const std::string text = spec.get_string_attribute("mcrender:units");
    if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != std::string::npos) return 0;
    return static_cast<uint32_t>(std::stoul(text));
}

/* Colours of other primaries would be read as wrong ones. 1e-3 allows for the roundings of Rec. 709 that are in use. */
bool primaries_differ(const OIIO::ImageSpec &spec)
{
    float found[8];
    if (!spec.getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), found)) return false;
    for (int i = 0; i < 8; i++)
        if (!(std::fabs(found[i] - rec709[i]) <= 1e-3f)) return true;
    return false;
}

/* What values are handed over as, and its MCR_OIIO_* (raw alone). */
OIIO::TypeDesc value_type(const OIIO::ImageSpec &spec, const mcr_oiio_input *input, uint32_t &type)
{
    type = MCR_OIIO_FLOAT;
    if (!input->raw) return OIIO::TypeDesc::DOUBLE;
    if (spec.format == OIIO::TypeDesc::UINT8) return type = MCR_OIIO_U8, OIIO::TypeDesc::UINT8;
    if (spec.format == OIIO::TypeDesc::UINT16) return type = MCR_OIIO_U16, OIIO::TypeDesc::UINT16;
    return OIIO::TypeDesc::FLOAT;
}

/* The reason why a file is not read, "" if it is. */
std::string refusal(const OIIO::ImageSpec &spec, const mcr_oiio_input *input)
{
    const auto side = static_cast<int64_t>(input->max_side);
    if (spec.deep) return "deep images are not read";
    if (spec.width < 1 || spec.height < 1 || spec.width > side || spec.height > side || spec.depth > 1)
        return "its size " + std::to_string(spec.width) + " x " + std::to_string(spec.height) + " is not within 1 to " + std::to_string(side);
    if (spec.nchannels < 1 || spec.nchannels > static_cast<int64_t>(input->max_channels))
        return "its " + std::to_string(spec.nchannels) + " channels are not within 1 to " + std::to_string(input->max_channels);
    const uint64_t values = uint64_t(spec.width) * uint64_t(spec.height) * uint64_t(spec.nchannels);
    uint32_t type;
    const uint64_t max_values = input->max_bytes / value_type(spec, input, type).size();
    const std::string size = std::to_string(spec.width) + " x " + std::to_string(spec.height);
    if (values > max_values) return "its size " + size + " is too large: over 1 GiB of pixels";
    /* Deflate holds at most 1032 bytes in one, a byte at most 8 values: what promises twice that is cut off or a lie. */
    if (values / (2 * 8 * 1032) > input->count) return "its " + std::to_string(input->count) + " bytes cannot hold " + size + " pixels";
    if (spec.tile_width > side || spec.tile_height > side || spec.tile_width < 0 || spec.tile_height < 0 ||
        uint64_t(spec.tile_width) * uint64_t(spec.tile_height) * uint64_t(spec.nchannels) > max_values)
        return "its tiles are too large";
    if (input->raw != MCR_OIIO_DATA && primaries_differ(spec)) return "its primaries (chromaticities) are not those of Rec. 709";
    return std::string();
}

int32_t read(const mcr_oiio_input *input, char *error, uint64_t length)
{
    return guarded(error, length, [&]() -> int32_t {
        settle(input);
        OIIO::Filesystem::IOMemReader proxy(const_cast<void *>(input->bytes), input->count);
        auto reader = OIIO::ImageInput::create(input->format, false);
        if (!reader) return fail(error, length, OIIO::geterror());
        OIIO::ImageSpec spec, config;
        config.attribute("oiio:UnassociatedAlpha", 1); /* no multiplication of encoded values */
        if (!reader->set_ioproxy(&proxy)) return fail(error, length, "this OpenImageIO cannot decode from memory");
        if (!reader->open("input", spec, config)) return fail(error, length, reader->geterror());
        const std::string reason = refusal(spec, input);
        if (!reason.empty()) return fail(error, length, reason);
        mcr_oiio_header header{};
        header.size = sizeof header;
        header.width = static_cast<uint32_t>(spec.width);
        header.height = static_cast<uint32_t>(spec.height);
        header.channels = static_cast<uint32_t>(spec.nchannels);
        header.bits = spec.format.is_floating_point() ? 0 : static_cast<uint32_t>(8 * spec.format.basesize());
        header.alpha = spec.alpha_channel;
        header.depth = spec.z_channel;
        std::string space;
        if (!transfer(spec, header, space) && input->raw != MCR_OIIO_DATA) return fail(error, length, "its colour space '" + space + "' is not known");
        std::vector<const char *> names;
        for (int c = 0; c < spec.nchannels; c++) names.push_back(spec.channelnames[size_t(c)].c_str());
        header.channel = names.data();
        header.units = units(spec);
        const OIIO::TypeDesc type = value_type(spec, input, header.type);
        void *values = input->begin(input->context, &header);
        if (!values) return fail(error, length, "not enough memory");
        if (!reader->read_image(0, 0, 0, spec.nchannels, type, values)) return fail(error, length, reader->geterror());
        /* Of files that are cut off some readers hand over what there is, and say so only here. */
        if (reader->has_error()) return fail(error, length, reader->geterror());
        return 0;
    });
}

} // namespace

extern "C" __attribute__((visibility("default"))) const struct mcr_oiio mcr_module;
const struct mcr_oiio mcr_module = {sizeof(struct mcr_oiio), MCR_OIIO_VERSION, MCR_OIIO_KIND, check, write, read};
