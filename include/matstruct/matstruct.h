// The whole public interface.
#pragma once

#include <matstruct/compute.h>
#include <matstruct/context.h>
#include <matstruct/error.h>
#include <matstruct/io.h>
#include <matstruct/metrics.h>
#include <matstruct/options.h>
#include <matstruct/reconstruct.h>
#include <matstruct/solid.h>
#include <matstruct/strata.h>
#include <matstruct/structure.h>
#include <matstruct/types.h>
#include <matstruct/version.h>
