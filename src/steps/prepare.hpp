#pragma once
/// @file
/// What a step needs before it solves anything: asked for by the step itself and by `check`.

#include "steps/context.hpp"

namespace tautline::steps {

/// Each sets the system up for its step. @throws ModelError for what no solve could mend
void prepare(Context& context, const ModalOptions& options);
void prepare(Context& context, const BucklingOptions& options);
void prepare(Context& context, const CollapseOptions& options);
void prepare(Context& context, const TuningStepOptions& options);
void prepare(Context& context, const InverseOptions& options);

}  // namespace tautline::steps
