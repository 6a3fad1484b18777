#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <system_error>

#include "app/command.hpp"
#include "app/commands.hpp"
#include "app/drawing.hpp"
#include "app/interrupt.hpp"
#include "results/output.hpp"

namespace arcslip {

namespace {

struct PlotRequest {
  std::string folder;
  std::string x;
  std::string size;
  std::vector<std::string> y, log, linear, range, format, only;

  /// As plots/plot.py takes them.
  std::vector<std::string> options() const {
    std::vector<std::string> all;
    const auto add = [&](const char* name, const std::string& value) {
      if (!value.empty()) all.push_back(fmt::format("--{}={}", name, value));
    };
    const auto add_all = [&](const char* name, const std::vector<std::string>& values) {
      for (const std::string& value : values) add(name, value);
    };
    add("x", x);
    add_all("y", y);
    add_all("log", log);
    add_all("linear", linear);
    add_all("range", range);
    add("size", size);
    add_all("format", format);
    add_all("only", only);
    return all;
  }
};

int plot(const PlotRequest& request) {
  catch_interrupts();
  const BeforeTheEnd say_so([] { complain("arcslip: interrupted"); });
  std::error_code none;
  if (std::filesystem::is_directory(request.folder, none) && access(request.folder.c_str(), W_OK) != 0)
    throw OutputError(
        fmt::format("{}: cannot be written: {}", request.folder, std::generic_category().message(errno)));
  try {
    print(draw(request.folder, request.options()));
  } catch (const MatplotlibNotFound&) {
    complain(
        "arcslip plot: no python3 with matplotlib was found; install it (Debian: apt-get install "
        "python3-matplotlib)");
    return status::cannot_write;
  } catch (const WrongRequest& wrong) {
    complain(wrong.reason);
    return status::wrong_command_line;
  }
  return status::done;
}

Command::Action add_plot(CLI::App& app) {
  const auto request = std::make_shared<PlotRequest>();
  CLI::App* command =
      app.add_subcommand("plot", "Draw what is in a folder of results (needs python3 with matplotlib)");
  command->add_option("DIR", request->folder, "Folder that `arcslip run`, `study` or `modes` wrote")
      ->required();
  command
      ->add_option("--x", request->x,
                   "Column of the tables for the horizontal axis, of a picture of your own")
      ->type_name("COLUMN");
  const auto list = [&](const char* name, std::vector<std::string>& values, const char* type,
                        const char* meaning) {
    return command->add_option(name, values, meaning)
        ->type_name(type)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  list("--y", request->y, "COLUMN",
       "Column for a panel of it; may be repeated. Lengths also as Y_mm, Y_um, Y_nm");
  list("--log", request->log, "x|y|xy", "Make these axes logarithmic")
      ->check(CLI::IsMember({"x", "y", "xy"}));
  list("--linear", request->linear, "x|y|xy", "Make these axes linear")
      ->check(CLI::IsMember({"x", "y", "xy"}));
  list("--range", request->range, "x=LOW:HIGH", "Range of the axis x or y; may be repeated");
  command->add_option("--size", request->size, "Width and height in cm")->type_name("WIDTHxHEIGHT");
  list("--format", request->format, "png|svg|pdf|eps", "PNG and SVG if not given; may be repeated")
      ->check(CLI::IsMember({"png", "svg", "pdf", "eps"}));
  list("--only", request->only, "PICTURE", "Draw this picture alone; may be repeated");
  return [request] { return plot(*request); };
}

}  // namespace

Command plot_command() { return {"plot", add_plot}; }

}  // namespace arcslip
