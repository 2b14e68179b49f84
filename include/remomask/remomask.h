#pragma once

// Everything of the library.

#include "remomask/clip.h"
#include "remomask/error.h"
#include "remomask/generation.h"
#include "remomask/library.h"
#include "remomask/motion.h"
#include "remomask/motion_file.h"
#include "remomask/progress.h"
#include "remomask/rotations.h"
#include "remomask/search.h"
#include "remomask/settings.h"
#include "remomask/skeleton.h"
#include "remomask/text_to_motion.h"
#include "remomask/training.h"
#include "remomask/version.h"
