// Option --stereo: a second eye beside each camera.
#pragma once

#include <string>

#include "testbench/command_line/command_line.h"
#include "testbench/streaminggs/run/run_config.h"

namespace sgs {

// stereo: takes the option's text, which is empty where there is one eye.
void add_stereo_to(CommandLine& line, std::string& stereo);

// Distance of the eyes in world units, as Camera::eyes_apart. Throws InputError.
double eyes_apart(const std::string& stereo);

// Builds the machine for as many eyes as there are. Before resolve(). Throws InputError where it
// was configured for others, or can draw one only.
void draw_eyes(RunConfig& config, double apart);

}  // namespace sgs
