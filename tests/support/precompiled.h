// msa/base/precompiled.h for the tests, which are compiled as parts of programs, not of libraries.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "msa/base/precompiled.h"
