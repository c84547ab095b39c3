#include "compare/plot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>

#include "luxel/input_error.h"

namespace luxel::compare {

namespace {

// Colours that stay apart in print and for the colour-blind (Okabe and Ito 2008).
constexpr std::array colours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                "#E69F00", "#56B4E9", "#000000", "#999999"};

// An error below this is rounding; a log axis needs something to show for it.
constexpr double smallest_shown = 1e-17;

std::string title_of(const Run& run) {
  std::string title(name(run.method));
  if (!run.stopped.empty()) title += " (" + run.stopped + ")";
  return title;
}

template <class Value>
std::string data_block(const std::string& block, const Run& run, Value value) {
  std::string text = "$" + block + " << EOD\n";
  for (const HistoryPoint& point : run.history) {
    const auto [x, y] = value(point);
    if (x > 0 && std::isfinite(y)) text += fmt::format("{:.9g} {:.9g}\n", x, std::max(y, smallest_shown));
  }
  return text + "EOD\n";
}

std::string gnuplot_script(const std::vector<Run>& runs, TimeAxis axis, const std::string& terminal) {
  const auto time = [axis](const HistoryPoint& point) {
    return axis == TimeAxis::cpu ? point.cpu_seconds : point.wall_seconds;
  };
  std::string script;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    script += data_block(fmt::format("error{}", i), runs[i],
                         [&](const HistoryPoint& p) { return std::pair(time(p), p.error); });
    script += data_block(fmt::format("bound{}", i), runs[i],
                         [&](const HistoryPoint& p) { return std::pair(time(p), p.error_bound); });
    script += data_block(fmt::format("residual{}", i), runs[i], [&](const HistoryPoint& p) {
      return std::pair(static_cast<double>(p.iteration), p.relative_residual);
    });
  }
  script += terminal == "png"
                ? "set terminal pngcairo size 1400,620 font 'DejaVu Sans,11' background 'white'\n"
                : "set terminal svg size 1400,620 font 'Helvetica,13' background 'white'\n";
  script +=
      "set multiplot layout 1,2\nset logscale y\nset format y '10^{%T}'\nset grid back lc '#dddddd'\n"
      "set key below maxrows 2 samplen 2\nset logscale x\nset format x '10^{%T}'\n";
  script +=
      fmt::format("set xlabel '{} time [s]'\nset ylabel 'max |B - B*| / max |B*|   (dashed: its bound)'\n",
                  axis == TimeAxis::cpu ? "CPU" : "wall");
  const auto curves = [&](const std::string& block, bool with_bound) {
    std::string text = "plot ";
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const char* colour = colours[i % colours.size()];
      text += fmt::format("{}${}{} with linespoints lc rgb '{}' lw 2 pt 7 ps 0.4 title '{}'", i ? ", " : "",
                          block, i, colour, title_of(runs[i]));
      if (with_bound) text += fmt::format(", $bound{} with lines lc rgb '{}' lw 1 dt 2 notitle", i, colour);
    }
    return text + "\n";
  };
  script += curves("error", true);
  script +=
      "unset logscale x\nset format x '%g'\nset xrange [0:*]\nset xlabel 'iteration'\nset ylabel 'relative "
      "residual'\n" +
      curves("residual", false);
  return script + "unset multiplot\n";
}

// Runs a program found on PATH with `input` on its standard input; returns its standard output.
std::string run_filter(const char* program, const std::string& input) {
  int to_child[2], from_child[2];
  if (pipe2(to_child, O_CLOEXEC) != 0 || pipe2(from_child, O_CLOEXEC) != 0)
    throw InputError("plot: no pipe to be had");
  const pid_t child = fork();
  if (child == 0) {
    dup2(to_child[0], STDIN_FILENO);
    dup2(from_child[1], STDOUT_FILENO);
    execlp(program, program, nullptr);
    _exit(127);
  }
  close(to_child[0]);
  close(from_child[1]);
  // gnuplot reads its whole script before it draws, so writing first cannot block on its output
  std::signal(SIGPIPE, SIG_IGN);
  for (std::size_t done = 0; done < input.size();) {
    const ssize_t written = write(to_child[1], input.data() + done, input.size() - done);
    if (written <= 0) break;
    done += written;
  }
  close(to_child[1]);
  std::string output;
  std::array<char, 65536> buffer;
  for (ssize_t got; (got = read(from_child[0], buffer.data(), buffer.size())) > 0;)
    output.append(buffer.data(), got);
  close(from_child[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) {
    throw InputError(
        fmt::format("plot: {} is not installed; on Debian: apt-get install gnuplot-nox", program));
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || output.empty()) {
    throw InputError(fmt::format("plot: {} failed", program));
  }
  return output;
}

}  // namespace

std::string plot(const std::vector<Run>& runs, TimeAxis axis, const std::string& terminal) {
  return run_filter("gnuplot", gnuplot_script(runs, axis, terminal));
}

}  // namespace luxel::compare
