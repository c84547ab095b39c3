#pragma once

namespace luxel::app {

// What stands below the options in the help of the program and of each command.

constexpr const char* main_footer =
    "\nExamples:\n"
    "  luxel solve room.obj -o room.vtp -o room.png     light for ParaView, and a picture\n"
    "  luxel factors room.obj --by group                form factors between the groups\n"
    "  luxel inspect room.obj                           what is in it and what is wrong with it\n"
    "\nluxel COMMAND --help tells the rest. Lengths are in metres, radiosity, irradiance and emission in "
    "W/m2.\n"
    "Exit status: 0 done, 1 not reached (not converged, accuracy not met), 2 input or command line "
    "unusable,\n"
    "3 a fault of luxel, 130 stopped by Ctrl-C.";

constexpr const char* solve_footer =
    "\nExamples:\n"
    "  luxel solve cornell.json -o cornell.vtp -o cornell.png\n"
    "  luxel solve room.obj --patches 20000 --accuracy 1e-4 -o room.vtp --json > room.json\n"
    "  luxel solve cube.obj --as-is --solver cholesky --tolerance 1e-12 -o cube.csv --full-precision\n"
    "  luxel solve room.obj --bounces 5 -o bounces.pvd     one time step a bounce, for ParaView\n"
    "\nUnits: lengths m; emission E, irradiance H and radiosity B W/m2; radiance is B / pi.";

constexpr const char* factors_footer =
    "\nExamples:\n"
    "  luxel factors room.obj --by group\n"
    "  luxel factors room.obj --as-is --accuracy 1e-6 -o factors.csv\n"
    "  luxel factors room.obj --point 1,1,0.8,0,0,1        from a point and its normal to every group\n"
    "  luxel factors room.obj --save room.luxel            keep them; then: luxel solve room.obj --load "
    "room.luxel\n"
    "\nF_ij is the share of what leaves patch i that arrives at patch j; A_i F_ij = A_j F_ji.";

constexpr const char* inspect_footer =
    "\nExamples:\n"
    "  luxel inspect room.obj\n"
    "  luxel inspect room.json --patches 100000 --json";

constexpr const char* compare_footer =
    "\nExamples:\n"
    "  luxel compare room.obj                              a table of all solvers\n"
    "  luxel compare room.json -o room.html -o room.json   with plots: error against time, residual\n"
    "  luxel compare room.obj --operators --solver cg,cholesky\n"
    "\nError: largest |B - B*| over patches and channels relative to the largest B*. A solver that takes ten "
    "times the\nothers' time is stopped and shown as such.";

constexpr const char* stress_footer =
    "\nExamples:\n"
    "  luxel stress\n"
    "  luxel stress reflectance_0.999999 pinhole_box --json\n"
    "\nVerdicts: exact (within the case's tolerance), bounded (error <= error bound <= 1e-2), refused (no "
    "result, "
    "the\ncause named), failed. Exit status 1 where a verdict is not one that the case allows.";

}  // namespace luxel::app
