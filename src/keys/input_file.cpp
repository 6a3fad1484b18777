#include "keys/input_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <system_error>

#include "arcslip/keys/input_error.hpp"
#include "keys/printable.hpp"

namespace arcslip {
namespace {

constexpr int patience = 5000;  // milliseconds
constexpr std::size_t piece = std::size_t{1} << 16;

/// Closes a file that was opened.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor(Descriptor&&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;

  int number() const { return number_; }

 private:
  int number_;
};

class InputFile {
 public:
  /// Does not wait for whoever may write into a pipe.
  explicit InputFile(const std::string& path)
      : path_(path), descriptor_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {
    struct stat status {};
    if (descriptor_.number() < 0 || fstat(descriptor_.number(), &status) != 0) fail(errno);
    if (S_ISDIR(status.st_mode)) fail(EISDIR);
    is_pipe_ = S_ISFIFO(status.st_mode);
    if (!is_pipe_ && !S_ISREG(status.st_mode)) fail("it is a device; expected a file");
    size_ = static_cast<std::size_t>(std::max<off_t>(status.st_size, 0));
  }

  /// As it is known beforehand, 0 of a pipe.
  std::size_t size() const { return size_; }

  /// Appends some bytes; false at the end.
  bool read_piece(std::string& text) const {
    const std::size_t before = text.size();
    text.resize(before + piece);
    ssize_t count = -1;
    do {
      if (is_pipe_) wait();
      count = read(descriptor_.number(), text.data() + before, piece);
    } while (count < 0 && (errno == EINTR || errno == EAGAIN));
    if (count < 0) fail(errno);
    text.resize(before + static_cast<std::size_t>(count));
    return count > 0;
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(fmt::format("{}: cannot be read: {}", path_, why));
  }

 private:
  [[noreturn]] void fail(int code) const { fail(std::generic_category().message(code)); }

  void wait() const {
    pollfd waiting{descriptor_.number(), POLLIN, 0};
    int ready = -1;
    while ((ready = poll(&waiting, 1, patience)) < 0 && errno == EINTR) {
    }
    if (ready == 0) fail(fmt::format("nothing came out of the pipe for {} s", patience / 1000));
  }

  const std::string& path_;
  Descriptor descriptor_;
  bool is_pipe_ = false;
  std::size_t size_ = 0;
};

}  // namespace

std::string read_text(const std::string& path, std::size_t most,
                      const std::function<void(std::string_view)>& begins) {
  if (path.find('\0') != path.npos)
    throw InputError(printable(path) + ": cannot be read: no file has such a name");
  const InputFile file(path);
  const auto too_large = [&] { file.fail(fmt::format("it holds more than {} MB", most >> 20)); };
  try {
    std::string text;
    bool more = true;
    while (more && text.size() < piece && text.find('\n') == text.npos) more = file.read_piece(text);
    if (begins) begins(text);
    if (file.size() > most) too_large();
    text.reserve(file.size() + piece);
    while (more) {
      more = file.read_piece(text);
      if (text.size() > most) too_large();
    }
    return text;
  } catch (const std::bad_alloc&) {
    file.fail("there is not enough memory for it");
  }
}

}  // namespace arcslip
