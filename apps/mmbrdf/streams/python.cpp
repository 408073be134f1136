// SPDX-License-Identifier: BSD-3-Clause
#include "streams/python.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <stdexcept>

namespace mmbrdf::program {

namespace {

/// Its first arguments are the command and the module.
constexpr const char* program_of_python =
    "import importlib, sys\n"
    "command, module = sys.argv[1:3]\n"
    "del sys.argv[1:3]\n"
    "try:\n"
    "    main = importlib.import_module(module).main\n"
    "except ImportError as error:\n"
    "    sys.exit(f'mmbrdf: {command} needs the Python package mmbrdf and matplotlib: {error}')\n"
    "sys.exit(main(prog=f'mmbrdf {command}'))\n";

}  // namespace

void become_python(const std::string& command, const std::string& module, const std::vector<std::string>& words) {
  const char* chosen = std::getenv("MMBRDF_PYTHON");
  const std::string interpreter = chosen != nullptr && *chosen != '\0' ? chosen : "python3";
  std::vector<std::string> arguments = {interpreter, "-c", program_of_python, command, module};
  arguments.insert(arguments.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  std::cout.flush();
  ::execvp(pointers.front(), pointers.data());
  throw std::runtime_error(command + " is drawn by Python: " + interpreter + ": " + std::strerror(errno) +
                           "; MMBRDF_PYTHON names another interpreter");
}

}  // namespace mmbrdf::program
