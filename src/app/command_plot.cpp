#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "app/commands.hpp"
#include "app/gnuplot.hpp"
#include "app/interrupt.hpp"
#include "app/pictures.hpp"
#include "results/output.hpp"

namespace arcslip {

int plot_command(const std::string& folder) {
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

}  // namespace arcslip
