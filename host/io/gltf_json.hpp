// Typed, checked access to a JSON value that remembers where in the document it stands, so that
// every complaint can say "nodes[3].mesh is 99, there are 24 meshes".
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace clgi::io::gltf {

class Value {
public:
    struct Member;

    explicit Value(const nlohmann::json& root);

    // Throws InputError "<path> <what>".
    [[noreturn]] void fail(const std::string& what) const;
    std::string path() const;

    // Objects. find gives nothing for an absent member; at refuses it.
    void expect_object() const;
    std::optional<Value> find(const char* key) const;
    Value at(const char* key) const;
    std::vector<Member> members() const;
    std::optional<Value> extension(const char* name) const;

    // Arrays. count refuses what is no array, or one longer than max_entries or `most`.
    std::size_t count(std::size_t most) const;
    std::size_t count() const;
    Value item(std::size_t i) const;

    // Leaves.
    double number() const;
    std::uint64_t integer() const;  // non-negative
    bool flag() const;
    std::string text() const;
    std::string name() const;  // text cut to a length that is safe to copy many times
    int index(std::size_t entries, const char* noun) const;
    std::vector<int> indices(std::size_t entries, const char* noun) const;
    std::vector<double> numbers() const;
    std::vector<double> numbers(std::size_t expected) const;

    // Members with a default.
    double number_or(const char* key, double fallback) const;
    std::uint64_t integer_or(const char* key, std::uint64_t fallback) const;
    bool flag_or(const char* key, bool fallback) const;
    std::string name_or_empty() const;  // the member "name"
    int index_or_none(const char* key, std::size_t entries, const char* noun) const;  // or -1
    glm::dvec3 vec3_or(const char* key, glm::dvec3 fallback) const;

private:
    struct Step {
        const char* key;  // null: an array item
        std::size_t item;
    };
    Value step(const nlohmann::json& child, Step step) const;

    const nlohmann::json* json_;
    std::array<Step, 10> steps_;  // glTF's own structure is at most 9 deep
    std::size_t depth_ = 0;
};

struct Value::Member {
    std::string key;
    Value value;
};

// More entries than this in one array of things is refused: a million empty objects take three
// megabytes of text and a hundred times that once they are nodes.
constexpr std::size_t max_entries = std::size_t{1} << 20;

// The same for things of which no scene has as many as it has nodes.
constexpr std::size_t max_rare_entries = std::size_t{1} << 16;

// Length of a top-level array, 0 when it is absent.
std::size_t entries(const Value& root, const char* key, std::size_t most = max_entries);

// Text from a file as it may appear in a message: one line, printable, of bounded length.
std::string printable(const std::string& text);

}  // namespace clgi::io::gltf
