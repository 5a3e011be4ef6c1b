// What glTF 2.0 asks of the kinds of the members that clgi and tinygltf read, as a table.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace clgi::io::gltf {

enum class Kind {
    object,
    list,  // an array of at most `limit` entries
    flag,
    text,
    word,  // a text that is one of `among`
    number,
    above_zero,
    not_negative,
    numbers,  // `limit` of them; 0: any number
    whole,    // at least 0, at most `limit`; 0: any
    count,    // the same from 1 on
    code,     // a whole number that is one of `among`
    index     // into the array `among` of the root; ".name": of the entry that holds the member
};

// A path is made of members and "[]", every entry of an array. "*Texture" is every member whose
// name ends so, "!" says that the member may not be absent where what holds it is there.
struct Rule {
    std::string_view path;
    Kind kind;
    std::string_view among = {};
    std::uint64_t limit = 0;
};

// More entries than this in one array of things is refused: a million empty objects take three
// megabytes of text and a hundred times that once they are nodes.
constexpr std::size_t max_entries = std::size_t{1} << 20;

std::span<const Rule> asset_rules();  // version and extensions: to be judged before the others
std::span<const Rule> rules();

}  // namespace clgi::io::gltf
