// SPDX-License-Identifier: MIT
#include <charconv>
#include <clgi/error.hpp>
#include <clgi/reference.hpp>
#include <sstream>

namespace clgi::reference {
namespace {

[[noreturn]] void refuse(const std::string& list, const std::string& why) {
    throw Error("reference: effects are '" + list + "': " + why);
}

int bounces_of(const std::string& list, const std::string& word) {
    const char* first = word.data() + word.find('=') + 1;
    const char* last = word.data() + word.size();
    int bounces = 0;
    const auto [end, error] = std::from_chars(first, last, bounces);
    if (error != std::errc() || end != last || bounces < 1 || bounces > 1000)
        refuse(list, "bounces=K with K from 1 to 1000 needed");
    return bounces;
}

}  // namespace

Effects parse_effects(const std::string& list) {
    if (list.empty() || list == "all") return {};
    Effects out;
    out.emission = out.direct = false;
    out.last_bounce = 0;
    bool indirect = false, any = false;
    const auto bounces = [&](int first, int last) {
        if (indirect) refuse(list, "one kind of indirect light at most");
        indirect = true;
        out.first_bounce = first;
        out.last_bounce = last;
    };
    if (list.back() == ',') refuse(list, "a word is missing at the end");
    std::istringstream words(list);
    for (std::string word; std::getline(words, word, ',');) {
        any = any || word.rfind("diffuse", 0) != 0;
        if (word == "emission") {
            out.emission = true;
        } else if (word == "direct") {
            out.direct = true;
        } else if (word == "indirect") {
            bounces(1, Effects::unlimited);
        } else if (word == "one-bounce") {
            bounces(1, 1);
        } else if (word.rfind("bounces=", 0) == 0) {
            const int count = bounces_of(list, word);
            bounces(count, count);
        } else if (word == "unshadowed-indirect") {
            bounces(1, 1);
            out.shadowed = false;
        } else if (word == "diffuse") {
            out.direct_gloss = out.indirect_gloss = false;
        } else if (word == "diffuse-indirect") {
            out.indirect_gloss = false;
        } else {
            refuse(list, "'" + word +
                             "' is none of emission, direct, indirect, one-bounce, bounces=K, "
                             "unshadowed-indirect, diffuse, diffuse-indirect");
        }
    }
    if (!any) {  // only what is left out was said
        Effects all;
        all.direct_gloss = out.direct_gloss;
        all.indirect_gloss = out.indirect_gloss;
        return all;
    }
    return out;
}

}  // namespace clgi::reference
