#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "app/command.hpp"
#include "app/commands.hpp"
#include "app/gnuplot.hpp"
#include "app/interrupt.hpp"
#include "app/pictures.hpp"
#include "results/output.hpp"

namespace arcslip {

namespace {

int plot(const std::string& folder) {
  catch_interrupts();
  const BeforeTheEnd say_so([] { complain("arcslip: interrupted"); });
  const std::vector<Picture> pictures = pictures_of(folder);
  if (access(folder.c_str(), W_OK) != 0) {
    throw OutputError(
        fmt::format("{}: cannot be written: {}", folder, std::generic_category().message(errno)));
  }
  try {
    draw(folder, pictures);
  } catch (const GnuplotNotFound&) {
    complain("arcslip plot: gnuplot was not found; install it (Debian: apt-get install gnuplot-nox)");
    return status::cannot_write;
  }
  return status::done;
}

Command::Action add_plot(CLI::App& app) {
  const auto folder = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("plot", "Draw what is in a folder of results (PNG and SVG; needs gnuplot)");
  command->add_option("DIR", *folder, "Folder that `arcslip run` or `arcslip study` wrote")->required();
  return [folder] { return plot(*folder); };
}

}  // namespace

Command plot_command() { return {"plot", add_plot}; }

}  // namespace arcslip
