#include <gtest/gtest.h>

#include "luxel/report.h"

namespace luxel {
namespace {

TEST(ReportSummary, AlignsLabelsAndGivesUnits) {
  Report report;
  report.run.threads = 2;
  report.scene = {"room.obj", 12, 8, 1, 24, true, 1, {"one warning"}};
  report.patches = 1234567;
  report.peak_bytes = 3 * 1024 * 1024;
  report.wall_seconds = 1.5;
  report.cpu_seconds = 2;

  EXPECT_EQ(summary(report),
            "scene        room.obj\n"
            "             12 faces, 8 vertices, 1 material, 24 m2, closed, 1 enclosure\n"
            "patches      1,234,567\n"
            "run          1.5 s (2 CPU s), 2 threads, peak memory 3.0 MiB\n"
            "warning      one warning\n");
}

TEST(ReportSummary, SaysWhatIsNotKnownAndWhatDidNotConverge) {
  Report report;
  report.solver.emplace();
  report.solver->method = "neumann";
  report.solver->iterations = 1;
  report.solver->relative_residual = 0.5;

  const std::string text = summary(report);

  EXPECT_NE(text.find("neumann: not converged after 1 iteration,"), std::string::npos) << text;
  EXPECT_NE(text.find("relative residual 0.5, error bound -\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace luxel
