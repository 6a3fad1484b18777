#include <fmt/format.h>

#include <memory>

#include "app/command.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/report.hpp"
#include "app/wrap.hpp"
#include "results/atomic_file.hpp"
#include "results/output.hpp"

namespace arcslip {

namespace {

int report(const std::string& folder) {
  catch_interrupts();
  const BeforeTheEnd say_so([] { complain("arcslip: interrupted"); });
  std::string page;
  try {
    page = report_page(folder);
  } catch (const PlotlyNotFound& missing) {
    complain(fmt::format(
        "arcslip report: {}: plotly.js, which draws the pictures, was not found; put plotly-basic.min.js of "
        "the "
        "npm package plotly.js-basic-dist-min there, or build where there is npm, or with "
        "-DARCSLIP_PLOTLY=FILE",
        missing.path));
    return status::cannot_write;
  }
  AtomicFile file(folder + "/report.html");
  file.write(page);
  file.commit();
  print(file.path() + "\n");
  return status::done;
}

constexpr const char* report_notes = R"(
Writes DIR/report.html, one page that opens in any browser without a network and may be sent as it is: the answer in
words, pictures to zoom, to read values from and to take curves out of, the tables, the case, and what was certified
and verified. It shows what is there, of a run, a study or both.)";

Command::Action add_report(CLI::App& app) {
  const auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("report", "Write a folder of results as one page to be sent (HTML)");
  command->add_option("DIR", *folder, "Folder that `arcslip run` or `arcslip study` wrote")->required();
  command->footer(as_paragraphs(report_notes));
  return [folder] { return report(*folder); };
}

}  // namespace

Command report_command() { return {"report", add_report}; }

}  // namespace arcslip
