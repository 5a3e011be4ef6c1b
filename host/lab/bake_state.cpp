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
    const auto fail = [&](const std::string& what) {
        throw InputError(file.string() + ": " + what);
    };
    std::size_t at = sizeof magic - 1;
    if (bytes.compare(0, at, magic) != 0) fail("is no state of a bake");
    // Never reads past the end, whatever lengths the file states.
    const auto get = [&](void* out, std::uint64_t count) {
        if (count > bytes.size() - at) fail("is damaged: it ends too early");
        if (count > 0) std::memcpy(out, bytes.data() + at, count);
        at += count;
    };
    const auto get_list = [&](auto& out) {
        std::uint64_t count = 0;
        get(&count, sizeof count);
        if (count > bytes.size() / sizeof out[0]) fail("is damaged: it ends too early");
        out.resize(count);
        get(out.data(), count * sizeof out[0]);
    };
    std::uint32_t found = 0;
    get(&found, sizeof found);
    if (found != version)
        fail("is of version " + std::to_string(found) + ", " + std::to_string(version) + " needed");
    std::string found_key;
    get_list(found_key);
    LightAtlasState out;
    each(
        out, [&](std::uint32_t& count) { get(&count, sizeof count); }, get_list);
    const std::uint64_t wanted = checksum(bytes.data(), at);
    std::uint64_t stated = 0;
    get(&stated, sizeof stated);
    if (stated != wanted || at != bytes.size()) fail("is damaged: its checksum is another");
    if (found_key != key)
        fail("belongs to a bake of another scene, with other options or on another device");
    return out;
}

}  // namespace clgi::lab
