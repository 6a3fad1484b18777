#include "arcslip/continuation/path/checkpoint.hpp"

#include "arcslip/continuation/path/journal.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <istream>
#include <limits>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string_view>

namespace arcslip::continuation {
namespace {

constexpr std::string_view signature = "arcslip-checkpoint-";
constexpr int newest = 8;  // of the versions of the text

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '\\' ? "\\\\" : c == '\n' ? "\\n" : std::string(1, c);
  return result;
}

std::string unescaped(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_escape = text[i] == '\\' && i + 1 < text.size();
    result += !is_escape ? text[i] : text[++i] == 'n' ? '\n' : text[i];
  }
  return result;
}

/// One value after another, each archive in its own direction.
class Writer {
 public:
  explicit Writer(std::ostream& out) : out_(out) { out_ << signature << newest << '\n'; }
  void operator()(const double& value) { out_ << fmt::format("{:a}\n", value); }
  void operator()(const int& value) { out_ << value << '\n'; }
  void operator()(const long& value) { out_ << value << '\n'; }
  void operator()(const std::string& value) { out_ << escaped(value) << '\n'; }
  static constexpr bool reads = false;
  static constexpr int version = newest;

 private:
  std::ostream& out_;
};

class Reader {
 public:
  explicit Reader(std::istream& in) : in_(in) {
    const std::string first = line();
    for (version = newest; version > 0; --version) {
      if (first == fmt::format("{}{}", signature, version)) return;
    }
    throw std::runtime_error(
        fmt::format("read_checkpoint: this is not a checkpoint of version 1 to {}", newest));
  }
  void operator()(double& value) { convert(value, std::strtod, "a number"); }
  void operator()(long& value) {
    convert(
        value, [](const char* text, char** end) { return std::strtol(text, end, 10); }, "an integer");
  }
  void operator()(int& value) {
    long wide = 0;
    (*this)(wide);
    value = static_cast<int>(wide);
  }
  void operator()(std::string& value) { value = unescaped(line()); }
  static constexpr bool reads = true;
  int version = 0;

 private:
  std::string line() {
    std::string text;
    if (!std::getline(in_, text)) throw std::runtime_error("read_checkpoint: the checkpoint is cut short");
    return text;
  }

  template <class Value, class Convert>
  void convert(Value& value, Convert conversion, const char* expected) {
    const std::string text = line();
    char* end = nullptr;
    value = conversion(text.c_str(), &end);
    if (text.empty() || *end != '\0')
      throw std::runtime_error(fmt::format("read_checkpoint: expected {}, got '{}'", expected, text));
  }

  std::istream& in_;
};

constexpr long most = 100'000'000;  // entries of a list

template <class Archive, class List, class Entry>
void list(Archive& archive, List& values, Entry entry) {
  auto size = static_cast<long>(values.size());
  archive(size);
  if constexpr (Archive::reads) {
    if (size < 0 || size > most) throw std::runtime_error("read_checkpoint: a list of impossible length");
    values.resize(static_cast<std::size_t>(size));
  }
  for (auto& value : values) entry(value);
}

template <class Archive, class Pattern>
void regime(Archive& archive, Pattern& value) {
  std::string states;
  if constexpr (!Archive::reads) states = digits(value);
  if (archive.version >= 3) archive(states);
  if constexpr (Archive::reads) {
    long bits = 0;  // one for each switch
    if (archive.version < 3) archive(bits);
    if (bits < 0 || bits > std::numeric_limits<int>::max())
      throw std::runtime_error("read_checkpoint: a regime that cannot be");
    value = archive.version < 3 ? regime_of_bits(static_cast<unsigned>(bits)) : regime_of_digits(states);
  }
}

template <class Archive, class Point>
void curve_point(Archive& archive, Point& point) {
  const auto number = [&](auto& value) { archive(value); };
  for (auto* v : {&point.unknowns, &point.parameters, &point.scale, &point.tangent})
    list(archive, *v, number);
  regime(archive, point.regime);
  archive(point.orientation);
  archive(point.residual);
  archive(point.iterations);
}

template <class Archive>
void counts(Archive& archive, std::conditional_t<Archive::reads, std::map<std::string, long>,
                                                 const std::map<std::string, long>>& found) {
  auto size = static_cast<long>(found.size());
  archive(size);
  if constexpr (Archive::reads) {
    for (long i = 0; i < size; ++i) {
      std::string name;
      archive(name);
      archive(found[name]);
    }
  } else {
    for (const auto& [name, count] : found) {
      archive(name);
      archive(count);
    }
  }
}

template <class Archive, class Way>
void progress(Archive& archive, Way& way) {
  const auto number = [&](auto& value) { archive(value); };
  curve_point(archive, way.here);
  curve_point(archive, way.start);
  auto& [bend, twist, change] = way.bends.derivatives;
  list(archive, bend, number);
  list(archive, way.monitors, [&](auto& monitor) {
    archive(monitor.value);
    archive(monitor.slope);
  });
  archive(way.signs.parameter);
  list(archive, way.signs.observables, number);
  list(archive, way.signs.functions, number);
  archive(way.signs.unstable);
  auto hold = static_cast<int>(way.hold);
  archive(hold);
  if constexpr (Archive::reads) way.hold = hold == 0 ? Hold::tangent : Hold::parameter;
  archive(way.distance);
  archive(way.arclength);
  counts(archive, way.found);
  if constexpr (Archive::reads) {
    for (auto* further : {&twist, &change}) further->setZero(bend.size());
    way.signs.since.assign(way.signs.observables.size(), std::numeric_limits<double>::infinity());
  }
  if (archive.version == 1) return;
  archive(way.last_value);
  archive(way.last_chord);
  list(archive, way.taken, number);
  archive(way.residual_size);
  list(archive, way.borders, number);
  archive(way.here.log_determinant);
  list(archive, way.past, [&](auto& past) {
    archive(past.behind);
    archive(past.sign);
    archive(past.log);
    archive(past.rate);
  });
  if constexpr (Archive::reads) {
    if (archive.version < 6) {  // those of cycles were told in other units
      if (std::isfinite(way.here.log_determinant)) way.here.log_determinant = std::nan("");
      way.past.clear();
    }
  }
  list(archive, way.looks, [&](auto& look) {
    archive(look.behind);
    list(archive, look.functions, number);
    list(archive, look.rates, number);
  });
  if (archive.version >= 4) archive(way.rescaled);
  if (archive.version < 5) return;
  archive(way.fold);
  archive(way.winding);
  int at_crossing = way.signs.at_crossing ? 1 : 0;
  archive(at_crossing);
  if constexpr (Archive::reads) way.signs.at_crossing = at_crossing != 0;
  for (auto& look : way.looks) list(archive, look.turns, number);
  if (archive.version < 7) return;
  for (auto* further : {&twist, &change}) list(archive, *further, number);
  archive(way.bends.length);
  if (archive.version < 8) return;
  list(archive, way.signs.since, number);
}

Stop read_stop(const std::string& name) {
  if (const std::optional<Stop> stop = stop_named(name)) return *stop;
  throw std::runtime_error(fmt::format("read_checkpoint: '{}' is no reason to stop", name));
}

template <class Archive, class Optional, class Entry>
void maybe(Archive& archive, Optional& value, Entry entry) {
  int there = value ? 1 : 0;
  archive(there);
  if constexpr (Archive::reads) {
    if (there != 0) value.emplace();
  }
  if (value) entry(*value);
}

/// Of the names of all patterns of switches, by their bits, those in which at most one is set.
std::vector<std::string> without_patterns(const std::vector<std::string>& names) {
  std::vector<std::string> kept;
  for (std::size_t bits = 0; bits < names.size(); bits = bits == 0 ? 1 : 2 * bits)
    kept.push_back(names[bits]);
  return kept;
}

template <class Archive, class Identity>
void identity(Archive& archive, Identity& of) {
  const auto name = [&](auto& value) { archive(value); };
  for (auto* names : {&of.parameters, &of.regimes, &of.tests, &of.extrema_of, &of.events})
    list(archive, *names, name);
  archive(of.parameter);
  if constexpr (Archive::reads) {
    if (archive.version == 2) of.regimes = without_patterns(of.regimes);
  }
}

template <class Archive, class State>
void all(Archive& archive, State& state) {
  const auto number = [&](auto& value) { archive(value); };
  const auto way = [&](auto& value) { progress(archive, value); };
  maybe(archive, state.of, [&](auto& of) { identity(archive, of); });
  maybe(archive, state.window, [&](auto& window) {
    archive(window.low);
    archive(window.high);
  });
  maybe(archive, state.ahead, way);
  std::string stop(to_string(state.stop_ahead));
  archive(stop);
  if constexpr (Archive::reads) state.stop_ahead = read_stop(stop);
  maybe(archive, state.back, way);
  maybe(archive, state.begin_back, [&](auto& guess) {
    list(archive, guess.unknowns, number);
    list(archive, guess.parameters, number);
    regime(archive, guess.regime);
    list(archive, guess.direction, number);
  });
}

template <class Archive, class Point>
void branch_point(Archive& archive, Point& point) {
  const auto number = [&](auto& value) { archive(value); };
  std::string type(to_string(point.type));
  archive(type);
  if constexpr (Archive::reads) {
    const auto known = point_type(type);
    if (!known) throw std::runtime_error(fmt::format("read_checkpoint: '{}' is no type of points", type));
    point.type = *known;
  }
  regime(archive, point.regime);
  list(archive, point.unknowns, number);
  list(archive, point.parameters, number);
  archive(point.arclength);
  archive(point.iterations);
  archive(point.residual);
  list(archive, point.tangent, number);
  list(archive, point.arrival, number);
  list(archive, point.eigenvalues, [&](auto& value) {
    auto [real, imaginary] = std::pair(value.real(), value.imag());
    archive(real);
    archive(imaginary);
    if constexpr (Archive::reads) value = {real, imaginary};
  });
  archive(point.unstable);
  archive(point.label);
}

template <class Archive, class Entry>
void journal_entry(Archive& archive, Entry& entry) {
  auto& branch = entry.branch;
  list(archive, branch.points, [&](auto& point) { branch_point(archive, point); });
  std::string stop(to_string(branch.stop));
  archive(stop);
  if constexpr (Archive::reads) branch.stop = read_stop(stop);
  archive(branch.explanation);
  archive(branch.warning);
  auto& work = branch.work;
  for (auto* count :
       {&work.evaluations, &work.factorizations, &work.iterations, &work.rejected_steps, &work.spectra})
    archive(*count);
  maybe(archive, branch.checkpoint, [&](auto& checkpoint) { all(archive, checkpoint); });
  list(archive, entry.borders, [&](auto& value) { archive(value); });
}

}  // namespace

void Journal::write(std::ostream& out) const {
  const std::scoped_lock lock(mutex_);
  Writer writer(out);
  list(writer, entries_, [&](const JournalEntry& entry) { journal_entry(writer, entry); });
}

void Journal::read(std::istream& in) {
  Reader reader(in);
  std::vector<JournalEntry> entries;
  list(reader, entries, [&](JournalEntry& entry) { journal_entry(reader, entry); });
  const std::scoped_lock lock(mutex_);
  entries_ = std::move(entries);
  next_ = 0;
}

void write(std::ostream& out, const Checkpoint& checkpoint) {
  Writer writer(out);
  all(writer, checkpoint);
}

Checkpoint read_checkpoint(std::istream& in) {
  Reader reader(in);
  Checkpoint checkpoint;
  if (reader.version == 1) {
    progress(reader, checkpoint.ahead.emplace());
  } else {
    all(reader, checkpoint);
  }
  return checkpoint;
}

}  // namespace arcslip::continuation
