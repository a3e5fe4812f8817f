#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "recordings/input_choice.h"
#include "report/comparison.h"

namespace roevo {

/// A recording, or a part of one, that is to become a column of the tables.
struct SequenceInput {
    std::string name;                    ///< unique, and fit for the name of a folder
    std::string input;                   ///< rawlog, bag or dataset folder, as given
    InputChoice choice;                  ///< of its frames
    std::size_t skip = 0, first = 0;     ///< at most `first` frames (0: all) after leaving out `skip`
    std::optional<double> paper_ate_cm;  ///< the paper's figure for just these frames
    std::string note;                    ///< what a list says of it that a reader must know; may be empty
};

/// Names for recordings: the rawlog's stem or the folder's name; where two have the same, the folder above
/// goes before it, and then a number behind it.
std::vector<std::string> sequenceNames(const std::vector<std::string>& inputs);

/// What of a recording is run, counted from 0: "frames 10 to 24". Empty when it is all of it.
/// @param size  number of its frames, 0 where that is not known
std::string partOf(const SequenceInput& sequence, std::size_t size);

/// Opens the recording and reads its ground truth and its first good frame, whose depth scale is checked.
/// @return with `failure` in words when the recording cannot be used, and without runs
/// @throws UsageError for options that do not suit the recording; std::runtime_error for a ground truth that
/// was named and cannot be read
SequenceComparison openSequence(const SequenceInput& sequence);

}  // namespace roevo
