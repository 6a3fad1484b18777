#include "commands.hpp"
namespace arcslip { int plot_command(const std::string&) { return 0; } }
