// Reads pictures through the shim of OpenImageIO, whole and damaged: shim.sh builds it with sanitizers.
// Usage: shim ROUNDS PICTURE...

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" {
struct PtPicture;
void pt_free(PtPicture*) noexcept;
int pt_read(const char*, std::uint64_t, PtPicture**, char*, std::size_t) noexcept;
void pt_size(const PtPicture*, int*, int*, int*) noexcept;
const std::uint8_t* pt_bytes(const PtPicture*) noexcept;
const float* pt_floats(const PtPicture*) noexcept;
std::size_t pt_attribute_count(const PtPicture*) noexcept;
void pt_attribute(const PtPicture*, std::size_t, const char**, const char**) noexcept;
}

namespace {

// Reads a file and looks at all that the shim says it has. Whether it is a picture.
bool look(const std::string& path) {
    PtPicture* picture = nullptr;
    char message[256] = "";
    if (pt_read(path.c_str(), std::uint64_t(1) << 30, &picture, message, sizeof message) != 0) {
        if (picture != nullptr || message[0] == 0) std::abort();
        return false;
    }
    int width = 0, height = 0, is_integer = 0;
    pt_size(picture, &width, &height, &is_integer);
    std::size_t values = 3 * std::size_t(width) * std::size_t(height);
    double sum = 0;
    for (std::size_t i = 0; i < values; ++i) {
        sum += pt_bytes(picture) != nullptr ? pt_bytes(picture)[i] : pt_floats(picture)[i];
    }
    for (std::size_t i = 0; i < pt_attribute_count(picture); ++i) {
        const char *name = nullptr, *value = nullptr;
        pt_attribute(picture, i, &name, &value);
        sum += std::string(name).size() + std::string(value).size();
    }
    pt_free(picture);
    return sum == sum || values > 0;
}

}  // namespace

int main(int count, char** arguments) {
    int rounds = std::atoi(arguments[1]);
    std::mt19937 random(1);
    for (int i = 2; i < count; ++i) {
        std::filesystem::path whole = arguments[i];
        std::ifstream file(whole, std::ios::binary);
        std::vector<char> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
        std::string damaged = "damaged" + whole.extension().string();
        int read = 0;
        for (int round = 0; round < rounds; ++round) {
            std::vector<char> copy = bytes;
            // Mostly in the header, where sizes and offsets are.
            std::size_t reach = round % 4 == 0 ? copy.size() : std::min<std::size_t>(copy.size(), 400);
            for (unsigned change = random() % 4; change > 0; --change) {
                copy[random() % reach] = char(random() % 3 == 0 ? 255 * (random() % 2) : random());
            }
            if (round % 3 == 0) copy.resize(random() % copy.size());
            std::ofstream(damaged, std::ios::binary).write(copy.data(), std::streamsize(copy.size()));
            read += look(damaged);
        }
        if (!look(whole.string())) return 1;
        std::printf("%s: %d of %d damaged files were still pictures\n", whole.c_str(), read, rounds);
    }
}
