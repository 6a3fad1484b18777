#pragma once

// `for_each` of a case file: what differs from one branch, or one design, to the next. Lists by key are
// walked together or combined with one another; an array of tables gives the sets one by one. A key in a
// table of its own goes by its dotted name, damper.width.

#include <memory>
#include <optional>

#include "keys/key_table.hpp"

namespace arcslip {

/// One set of values.
struct ForEachSet {
  nlohmann::ordered_json values;                        ///< by key, in the order of the file
  Replacements replacements;                            ///< of [system] and [geometry], and of branch.eta
  std::vector<std::unique_ptr<const toml::node>> made;  ///< values of ranges, which the replacements point to
};

class ForEach {
 public:
  enum class Lists { together, combined };  ///< combined: every value with every other, the last key fastest

  /// Reads `for_each` of a section, if it has one. Throws InputError.
  ForEach(const TomlDocument& document, const TomlSection& section, const std::vector<ListedKey>& listed,
          Lists lists);

  const std::vector<std::string>& keys() const { return keys_; }
  bool sets(const std::string& key) const;
  std::size_t count() const { return count_; }  ///< of sets; one, which is empty, without `for_each`
  ForEachSet at(std::size_t index) const;

  /// Indices of all sets or, of more than 10^6, of as many among them. Of more than 10^4 that are combined,
  /// of sets among which each value of a key stands beside the largest one of each other key: as many as the
  /// lists are long, not as their product. Of ranges the first two values and the last one do.
  std::vector<std::size_t> samples() const;

  /// The first set without what the file has values of its own for, which no set shows.
  ForEachSet lacking() const;

  /// As it was written, keys in the order of the file.
  nlohmann::ordered_json to_json() const;

 private:
  struct Range {
    double from = 0, to = 0;
    bool logarithmic = false;
    bool integers = false;  ///< given by integers
  };

  /// The values of one key.
  struct Axis {
    std::string key;
    std::string path = {};  ///< of what it replaces
    std::size_t count = 0;
    std::vector<const toml::node*> listed = {};  ///< empty of a range
    std::optional<Range> range = {};
    const toml::node* place = nullptr;  ///< of the list or range in the file
    std::size_t largest = 0;            ///< index of the largest number

    double number(std::size_t index) const;
    std::unique_ptr<const toml::node> make(std::size_t index) const;
  };

  void read_tables(const TomlSection& section, const toml::array& tables,
                   const std::vector<std::string>& allowed);
  void read_lists(const TomlSection& section, const std::vector<std::string>& allowed, Lists lists);
  Axis read_axis(const std::string& key, const toml::node& node) const;
  Range read_range(const TomlSection& section, std::size_t& count) const;
  std::string name(const Axis& axis, std::size_t index) const;

  const TomlDocument* document_;
  std::string path_;     ///< of `for_each`
  bool tables_ = false;  ///< whether it is an array of tables
  bool combined_ = false;
  std::vector<std::string> keys_;
  std::vector<Axis> axes_;
  std::size_t count_ = 1;
};

}  // namespace arcslip
