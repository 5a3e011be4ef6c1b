// SPDX-License-Identifier: MIT
#include "lab/bake_state.hpp"

#include <clgi/error.hpp>
#include <cstring>
#include <fstream>
#include <iterator>

#include "io/atomic_file.hpp"

namespace clgi::lab {
namespace {

constexpr char magic[] = "clgi bake state\n";  // without its last zero
constexpr std::uint32_t version = 2;

std::uint64_t checksum(const char* bytes, std::size_t count) {
    std::uint64_t out = 0xcbf29ce484222325u;
    for (std::size_t i = 0; i < count; ++i)
        out = (out ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3u;
    return out;
}

template <typename T>
void put(std::string& out, const T& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename T>
void put(std::string& out, const std::vector<T>& values) {
    put(out, std::uint64_t{values.size()});
    out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

// All counts and all lists of a state, in the order of the file.
template <typename State, typename Count, typename List>
void each(State& state, const Count& count, const List& list) {
    for (auto* value :
         {&state.vpls, &state.texels, &state.measured_vpls, &state.filled_vpls, &state.shots})
        count(*value);
    list(state.rows);
    list(state.seen);
    for (auto* values : {&state.balance, &state.light, &state.irradiance, &state.filled})
        list(*values);
}

// Never reads past the end, whatever lengths the file states.
class Reader {
public:
    Reader(const std::filesystem::path& file, const std::string& bytes)
        : file_(file), bytes_(bytes) {}

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(file_.string() + ": " + what);
    }

    std::string text(std::uint64_t count) {
        if (count > bytes_.size() - at_) fail("is damaged: it ends too early");
        at_ += count;
        return bytes_.substr(at_ - count, count);
    }

    template <typename T>
    T value() {
        T out;
        std::memcpy(&out, text(sizeof out).data(), sizeof out);
        return out;
    }

    template <typename T>
    void list(std::vector<T>& out) {
        const auto count = value<std::uint64_t>();
        if (count > bytes_.size() / sizeof(T)) fail("is damaged: it ends too early");
        const std::string raw = text(count * sizeof(T));
        out.resize(count);
        if (count > 0) std::memcpy(out.data(), raw.data(), raw.size());
    }

    std::size_t at() const { return at_; }
    bool ended() const { return at_ == bytes_.size(); }

private:
    const std::filesystem::path& file_;
    const std::string& bytes_;
    std::size_t at_ = 0;
};

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::string out{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (!in || in.bad()) throw InputError(file.string() + ": cannot be read");
    return out;
}

}  // namespace

void save_bake_state(const LightAtlasState& state, const std::string& key,
                     const std::filesystem::path& file) {
    std::string out(magic, sizeof magic - 1);
    put(out, version);
    put(out, std::uint64_t{key.size()});
    out += key;
    each(
        state, [&](std::uint32_t count) { put(out, count); },
        [&](const auto& values) { put(out, values); });
    put(out, checksum(out.data(), out.size()));
    io::AtomicFile writer(file);
    writer.write(out.data(), out.size());
    writer.commit();
}

LightAtlasState load_bake_state(const std::filesystem::path& file, const std::string& key) {
    const std::string bytes = bytes_of(file);
    Reader in(file, bytes);
    if (bytes.size() < sizeof magic - 1 || in.text(sizeof magic - 1) != magic)
        in.fail("is no state of a bake");
    const auto found = in.value<std::uint32_t>();
    if (found != version)
        in.fail("is of version " + std::to_string(found) + ", " + std::to_string(version) +
                " needed");
    const std::string found_key = in.text(in.value<std::uint64_t>());
    LightAtlasState out;
    each(
        out, [&](std::uint32_t& count) { count = in.value<std::uint32_t>(); },
        [&](auto& values) { in.list(values); });
    const std::size_t end = in.at();
    if (in.value<std::uint64_t>() != checksum(bytes.data(), end) || !in.ended())
        in.fail("is damaged: its checksum is another");
    if (found_key != key)
        in.fail("belongs to a bake of another scene, with other options or on another device");
    return out;
}

}  // namespace clgi::lab
