/// Whether units, zeros, signs and the order of columns in recordings are those of the model. Where they are not, every answer would be
/// wrong: a search for physical causes bends a force law until an angle of the other sign fits.
#pragma once

#include <string>
#include <vector>

#include "plant.h"

namespace musclesim {

/// Throws BadFile, with what to do about it, if readings can only be meant otherwise than their columns say. `nominal`: the model without
/// further effects, one prediction per recording. In this order:
/// - seconds: a recording lasts less than 0.1 s
/// - thousands: a signal is about a thousand times as large as in the model, or a thousandth of it
/// - turn: a counter of angles wraps round; full scale: pressures lie beyond it
/// - radians: an angle that follows the model moves by about 57 times less or more
/// - zero and range: nearly all angles lie beyond the stops of the joint, lengths beyond what the muscle can be, pressures one atmosphere
///   above the commands
/// - one recording alone follows another column, or is unlike the others
/// - clocks: a signal follows the model much better under another clock
/// - order and sign: two columns follow each other's model; an angle or a length moves opposite to the model
/// Exchanged commands turn the motion round, too, and are a cause that the catalogue has (channel_swap). Signs and the order of pressures
/// are therefore only refused if the other signals rule that out. Where nothing does, the result has a sentence on it.
std::vector<std::string> checkConventions(const Plant& plant, const std::vector<Prediction>& nominal);

}  // namespace musclesim
