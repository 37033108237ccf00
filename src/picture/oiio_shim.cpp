// What the program asks of OpenImageIO, as C functions: opaque handles, no exception leaves, every failure is a code and
// a message in the caller's buffer. Built to a shared object that is loaded when a picture first needs it.

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace {

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

// Values of a picture, of all its channels, must be fewer: 2^33 bytes of floats.
constexpr std::uint64_t most_values = std::uint64_t(1) << 31;
constexpr int most_side = 1 << 20;

int fail(char* message, std::size_t size, const std::string& why) noexcept {
    std::snprintf(message, size, "%s", why.empty() ? "OpenImageIO gives no reason" : why.c_str());
    return 1;
}

// Runs `work`, which returns a message or an empty text, and turns whatever it throws into a message.
template <typename Work>
int guarded(char* message, std::size_t size, Work work) noexcept {
    try {
        std::string why;
        return work(why) ? 0 : fail(message, size, why);
    } catch (const std::bad_alloc&) {
        return fail(message, size, "there is not enough memory");
    } catch (const std::exception& error) {
        std::snprintf(message, size, "%s", error.what());
        return 1;
    } catch (...) {
        std::snprintf(message, size, "an unknown exception");
        return 1;
    }
}

// The three channels that show the picture: R, G and B by name, else the first ones; of fewer than three the first.
void choose_channels(const ImageSpec& spec, int (&channels)[3]) {
    const char* names[3] = {"R", "G", "B"};
    for (int i = 0; i < 3; ++i) {
        channels[i] = spec.channelindex(names[i]);
    }
    if (channels[0] < 0 || channels[1] < 0 || channels[2] < 0) {
        for (int i = 0; i < 3; ++i) {
            channels[i] = spec.nchannels < 3 ? 0 : i;
        }
    }
}

template <typename Value>
bool read_values(ImageInput& input, const ImageSpec& spec, TypeDesc type, std::vector<Value>& rgb) {
    std::size_t pixels = std::size_t(spec.width) * std::size_t(spec.height);
    std::vector<Value> all(pixels * std::size_t(spec.nchannels));
    if (!input.read_image(0, 0, 0, spec.nchannels, type, all.data())) {
        return false;
    }
    int channels[3];
    choose_channels(spec, channels);
    rgb.resize(3 * pixels);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        for (std::size_t i = 0; i < 3; ++i) {
            rgb[3 * pixel + i] = all[pixel * std::size_t(spec.nchannels) + std::size_t(channels[i])];
        }
    }
    return true;
}

}  // namespace

extern "C" {

// A picture that was read. Either `bytes` or `floats` holds its R G B; neither if only its header was asked for.
struct PtPicture {
    int width = 0;
    int height = 0;
    bool is_integer = false;
    std::vector<std::uint8_t> bytes;
    std::vector<float> floats;
    std::vector<std::pair<std::string, std::string>> attributes;
};

void pt_free(PtPicture* picture) noexcept { delete picture; }

// Reads the first subimage of a file, with its pixels if `most_bytes` of memory, which are not 0, are enough for them.
int pt_read(const char* path, std::uint64_t most_bytes, PtPicture** out, char* message, std::size_t size) noexcept {
    *out = nullptr;
    return guarded(message, size, [&](std::string& why) {
        ImageSpec config;
        // Colours as they are, not multiplied by alpha, which is left out.
        config.attribute("oiio:UnassociatedAlpha", 1);
        auto input = ImageInput::open(path, &config);
        if (!input) {
            why = OIIO::geterror();
            return false;
        }
        const ImageSpec spec = input->spec();
        bool is_sane = spec.width > 0 && spec.height > 0 && spec.width <= most_side && spec.height <= most_side &&
                       spec.depth <= 1 && spec.nchannels > 0 && spec.nchannels <= 1024;
        if (!is_sane || spec.image_pixels() * std::uint64_t(spec.nchannels) >= most_values) {
            why = "its size is not one of a picture: " + std::to_string(spec.width) + " x " +
                  std::to_string(spec.height) + " pixels of " + std::to_string(spec.nchannels) + " channels";
            return false;
        }
        bool is_byte = spec.format == TypeDesc::UINT8;
        // All channels, the three that are kept, and the caller's copy of these.
        std::uint64_t needed = spec.image_pixels() * (std::uint64_t(spec.nchannels) + 6) * (is_byte ? 1 : sizeof(float));
        if (most_bytes != 0 && needed > most_bytes) {
            why = "its " + std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels take " +
                  std::to_string(needed >> 20) + " MB of memory, and " + std::to_string(most_bytes >> 20) + " MB are free";
            return false;
        }
        auto picture = std::make_unique<PtPicture>();
        picture->width = spec.width;
        picture->height = spec.height;
        picture->is_integer = !spec.format.is_floating_point();
        for (const auto& attribute : spec.extra_attribs) {
            picture->attributes.emplace_back(attribute.name().string(), attribute.get_string());
        }
        bool is_read = most_bytes == 0 ||
                       (is_byte ? read_values(*input, spec, TypeDesc::UINT8, picture->bytes)
                                : read_values(*input, spec, TypeDesc::FLOAT, picture->floats));
        if (!is_read) {
            why = input->geterror();
            return false;
        }
        *out = picture.release();
        return true;
    });
}

void pt_size(const PtPicture* picture, int* width, int* height, int* is_integer) noexcept {
    *width = picture->width;
    *height = picture->height;
    *is_integer = picture->is_integer ? 1 : 0;
}

// Null if the picture has floats.
const std::uint8_t* pt_bytes(const PtPicture* picture) noexcept {
    return picture->bytes.empty() ? nullptr : picture->bytes.data();
}

// Null if the picture has bytes.
const float* pt_floats(const PtPicture* picture) noexcept {
    return picture->floats.empty() ? nullptr : picture->floats.data();
}

std::size_t pt_attribute_count(const PtPicture* picture) noexcept { return picture->attributes.size(); }

void pt_attribute(const PtPicture* picture, std::size_t index, const char** name, const char** value) noexcept {
    *name = picture->attributes[index].first.c_str();
    *value = picture->attributes[index].second.c_str();
}

// Writes R G B of `bits` a value: 8 or 16 encoded as sRGB, 32 linear floats. `format` is an extension. `attributes` are
// names and values in turn.
int pt_write(const char* path, const char* format, int width, int height, int bits, const void* rgb,
             const char* const* attributes, std::size_t attribute_count, char* message, std::size_t size) noexcept {
    return guarded(message, size, [&](std::string& why) {
        auto output = ImageOutput::create(std::string("picture.") + format);
        if (!output) {
            why = OIIO::geterror();
            return false;
        }
        TypeDesc type = bits == 8 ? TypeDesc::UINT8 : bits == 16 ? TypeDesc::UINT16 : TypeDesc::FLOAT;
        ImageSpec spec(width, height, 3, type);
        spec.attribute("oiio:ColorSpace", bits == 32 ? "Linear" : "sRGB");
        for (std::size_t i = 0; i < attribute_count; ++i) {
            spec.attribute(attributes[2 * i], attributes[2 * i + 1]);
        }
        bool is_written = output->open(path, spec) && output->write_image(type, rgb);
        // A writer may find out only here that the disk is full.
        if (!(output->close() && is_written)) {
            why = output->geterror();
            return false;
        }
        return true;
    });
}

}  // extern "C"
