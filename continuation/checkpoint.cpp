#include "arcslip/continuation/checkpoint.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <istream>
#include <ostream>
#include <stdexcept>

namespace arcslip::continuation {
namespace {

constexpr const char* signature = "arcslip-checkpoint-1";

/// One value after another, each archive in its own direction.
class Writer {
 public:
  explicit Writer(std::ostream& out) : out_(out) { out_ << signature << '\n'; }
  void operator()(const double& value) { out_ << fmt::format("{:a}\n", value); }
  void operator()(const int& value) { out_ << value << '\n'; }
  void operator()(const long& value) { out_ << value << '\n'; }
  void operator()(const std::string& value) { out_ << value << '\n'; }
  static constexpr bool reads = false;

 private:
  std::ostream& out_;
};

class Reader {
 public:
  explicit Reader(std::istream& in) : in_(in) {
    if (line() != signature) throw std::runtime_error("read_checkpoint: this is not a checkpoint");
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
  void operator()(std::string& value) { value = line(); }
  static constexpr bool reads = true;

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

template <class Archive, class Point>
void curve_point(Archive& archive, Point& point) {
  const auto number = [&](auto& value) { archive(value); };
  for (auto* v : {&point.unknowns, &point.parameters, &point.scale, &point.tangent})
    list(archive, *v, number);
  archive(point.regime);
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

template <class Archive, class State>
void all(Archive& archive, State& state) {
  const auto number = [&](auto& value) { archive(value); };
  curve_point(archive, state.here);
  curve_point(archive, state.start);
  list(archive, state.bend, number);
  list(archive, state.monitors, [&](auto& monitor) {
    archive(monitor.value);
    archive(monitor.slope);
  });
  archive(state.signs.parameter);
  list(archive, state.signs.observables, number);
  list(archive, state.signs.functions, number);
  archive(state.signs.unstable);
  auto hold = static_cast<int>(state.hold);
  archive(hold);
  if constexpr (Archive::reads) state.hold = hold == 0 ? Hold::tangent : Hold::parameter;
  archive(state.distance);
  archive(state.arclength);
  counts(archive, state.found);
}

}  // namespace

void write(std::ostream& out, const Checkpoint& checkpoint) {
  Writer writer(out);
  all(writer, checkpoint);
}

Checkpoint read_checkpoint(std::istream& in) {
  Reader reader(in);
  Checkpoint checkpoint;
  all(reader, checkpoint);
  return checkpoint;
}

}  // namespace arcslip::continuation
