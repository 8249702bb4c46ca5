// The name that a misspelt word most likely means.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sgs {

// Place of the name that the fewest insertions, deletions, exchanges and swaps of neighbours make
// of `word`; the first of several. None where that takes more than a third of its letters.
std::optional<std::size_t> nearest_name(const std::string& word,
                                        const std::vector<std::string>& names);

// The same among paths of keys, "sram.input_bytes", by their last keys; of several as near, that
// with the nearest path.
std::optional<std::size_t> nearest_key(const std::string& key,
                                       const std::vector<std::string>& paths);

// "; did you mean exact?", behind what was got; empty where no name is near.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& names);

// The same, and the words that lead to what is allowed: a long list comes behind the question.
std::string then_expected(const std::string& question);

}  // namespace sgs
