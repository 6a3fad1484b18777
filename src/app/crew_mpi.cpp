#include <algorithm>
#include <array>
#include <boost/mpi.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>
#include <cstdlib>
#include <optional>
#include <thread>

#include "app/commands.hpp"
#include "app/crew.hpp"
#include "results/output.hpp"

namespace arcslip::problems {

template <class Archive>
void serialize(Archive& archive, PeakSensitivity& by, unsigned /*version*/) {
  archive& by.preload& by.friction& by.force& by.mass_ratio& by.frequency_ratio;
}

template <class Archive>
void serialize(Archive& archive, Peak& peak, unsigned /*version*/) {
  archive& peak.type& peak.site& peak.preload& peak.eta& peak.Y& peak.R_over_S& peak.dissipated;
  archive& peak.sensitivity& peak.is_global;
}

template <class Archive>
void serialize(Archive& archive, QuantileRow& row, unsigned /*version*/) {
  archive& row.preload& row.Y& row.errors;
}

template <class Archive>
void serialize(Archive& archive, UncertainPeaks& peaks, unsigned /*version*/) {
  archive& peaks.rows& peaks.preload& peaks.Y& peaks.Y_nominal& peaks.error& peaks.sampling_error& peaks
      .failure;
}

template <class Archive, class Value>
void serialize_optional(Archive& archive, std::optional<Value>& value) {
  bool there = value.has_value();
  archive& there;
  if (there && !value) value.emplace();
  if (there) archive&* value;
}

template <class Archive>
void serialize(Archive& archive, Optimum& optimum, unsigned /*version*/) {
  archive& optimum.kind& optimum.peak& optimum.low& optimum.high& optimum.energy& optimum.damping;
  serialize_optional(archive, optimum.other);
}

template <class Archive>
void serialize(Archive& archive, PreloadStudy& study, unsigned /*version*/) {
  archive& study.free_eta& study.free_Y& study.branches& study.failure& study.harmonics;
  serialize_optional(archive, study.optimum);
}

}  // namespace arcslip::problems

namespace arcslip {

/// The values that for_each sets are left out: they follow from the curve.
template <class Archive>
void serialize(Archive& archive, FinishedDesign& design, unsigned /*version*/) {
  archive& design.curve& design.result;
  problems::serialize_optional(archive, design.uncertain);
}

namespace {

namespace mpi = boost::mpi;

enum Tag { report_tag, order_tag };

/// What an assistant tells: each is answered by an order but for the last one.
struct Report {
  std::vector<FinishedDesign> finished;
  std::size_t room = 0;  ///< for how many designs
  bool last = false;

  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    archive& finished& room& last;
  }
};

/// Designs to compute; then whether more will come, and whether those not begun are to be dropped.
struct Order {
  std::vector<std::size_t> curves;
  bool more = true;
  bool drop = false;

  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    archive& curves& more& drop;
  }
};

/// The next designs for an assistant: fewer towards the end, so that all come to it together.
Order next_order(PendingDesigns& pending, std::size_t room, std::size_t assistants) {
  Order order;
  const std::size_t share = std::max<std::size_t>(1, pending.left() / (2 * assistants));
  while (pending.left() > 0 && order.curves.size() < std::min(room, share))
    order.curves.push_back(pending.next());
  order.more = pending.left() > 0;
  return order;
}

}  // namespace

struct Crew::Processes {
  mpi::environment environment{mpi::threading::funneled, false};
  mpi::communicator world;
  std::size_t working = static_cast<std::size_t>(world.size()) - 1;  ///< assistants without a last report

  /// The next report, if there is one, with its sender.
  std::optional<std::pair<int, Report>> next() const {
    const auto message = world.iprobe(mpi::any_source, report_tag);
    if (!message) return std::nullopt;
    std::pair<int, Report> received{message->source(), {}};
    world.recv(received.first, report_tag, received.second);
    return received;
  }
};

Crew::Crew() {
  // A process that nothing started as one of several does without MPI, which would start a daemon for it.
  constexpr std::array launchers = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_SIZE"};
  if (std::any_of(launchers.begin(), launchers.end(), [](auto name) { return std::getenv(name) != nullptr; }))
    processes_ = std::make_unique<Processes>();
}

Crew::~Crew() = default;

bool Crew::leads() const { return !processes_ || processes_->world.rank() == 0; }

std::size_t Crew::default_jobs() const {
  if (processes_ && processes_->world.size() > 1) return 1;
  return std::max(1U, std::thread::hardware_concurrency());
}

std::size_t Crew::threads(std::size_t jobs) const {
  return processes_ && processes_->working > 0 ? processes_->working * jobs : jobs;
}

bool Crew::agree(const std::string& error) const {
  const int self = processes_ ? processes_->world.rank() : 0;
  const int none = processes_ ? processes_->world.size() : 1;
  int first = error.empty() ? none : self;
  if (processes_) first = mpi::all_reduce(processes_->world, first, mpi::minimum<int>());
  if (first == self) complain(error);
  if (processes_) processes_->world.barrier();
  return first == none;
}

std::size_t Crew::compute(const StudyCase& study, std::size_t jobs, PendingDesigns& pending,
                          const std::function<void(const FinishedDesign&)>& keep,
                          const std::function<bool()>& go_on) {
  if (!processes_ || processes_->world.size() == 1) {
    StudyWorkers workers(study, jobs);
    return arcslip::compute(workers, pending, keep, go_on);
  }
  const std::size_t assistants = processes_->working;
  std::size_t computed = 0;
  bool going = true;
  while (processes_->working > 0) {
    going = going && go_on();
    auto message = processes_->next();
    if (!message) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      continue;
    }
    auto& [sender, report] = *message;
    if (report.last) {
      --processes_->working;
    } else {
      const Order order = going ? next_order(pending, report.room, assistants) : Order{{}, false, true};
      processes_->world.send(sender, order_tag, order);
    }
    for (FinishedDesign& design : report.finished) {
      design.values = study.design(design.curve).values;
      keep(design);
      ++computed;
    }
  }
  return computed;
}

void Crew::dismiss(int status) {
  if (!processes_) return;
  while (processes_->working > 0) {
    const auto message = processes_->next();
    if (!message) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } else if (message->second.last) {
      --processes_->working;
    } else {
      processes_->world.send(message->first, order_tag, Order{{}, false, true});
    }
  }
  mpi::broadcast(processes_->world, status, 0);
}

int Crew::assist(const StudyCase& study, std::size_t jobs) {
  const mpi::communicator& world = processes_->world;
  try {
    StudyWorkers workers(study, jobs);
    Report report;
    bool more = true;
    for (;;) {
      report.last = !more && workers.open() == 0;
      report.room = more ? workers.wanted() - workers.open() : 0;
      world.send(0, report_tag, report);
      if (report.last) break;
      Order order;
      world.recv(0, order_tag, order);
      for (const std::size_t curve : order.curves) workers.give(curve);
      if (order.drop) workers.drop();
      more = more && order.more;
      report.finished.clear();
      while (report.finished.empty() && workers.open() > 0)
        report.finished = workers.take(std::chrono::milliseconds(100));
    }
  } catch (const std::exception& error) {
    complain(std::string("arcslip: ") + error.what());
    mpi::environment::abort(status::wrong_input);
  }
  int status = 0;
  mpi::broadcast(world, status, 0);
  return status;
}

}  // namespace arcslip
